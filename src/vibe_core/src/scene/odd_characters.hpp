#pragma once
#include <map>
#include <string>

namespace vibe {

/// Characters of a text outside its comments that look like others which YAML, keys, numbers and units are made of:
/// blanks that do not break, letters of other alphabets, typographic quotes and signs; and tabs at the beginning of a
/// line. Texts may well contain them, so they are named only where something else is wrong.
/// @return per line, from 1, a clause about the first of them, e.g. "column 6 has a no-break space (U+00A0) in the
/// place
///         of ' '"
std::map<int, std::string> oddCharacters(const std::string& text);

}  // namespace vibe
