#pragma once

#include <map>
#include <string>

#include "vibe_core/scene/yaml_source.hpp"

namespace vibe {

/// A text from a user's file, prepared for an error message: control characters are replaced by '?', and the text is
/// cut after `max_bytes` bytes, with "..." in place of the rest.
inline std::string printable(const std::string& text, std::size_t max_bytes) {
  std::string result = text.substr(0, max_bytes);
  for (char& c : result) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return text.size() > max_bytes ? result + "..." : result;
}

/// Characters of a text outside its comments that look like others which YAML, keys, numbers and units are made of:
/// blanks that do not break, letters of other alphabets, typographic quotes and signs; and tabs at the beginning of a
/// line. Texts may well contain them, so they are named only where something else is wrong.
/// @return per line, from 1, a clause about the first of them, e.g. "column 6 has a no-break space (U+00A0) in the
/// place
///         of ' '"
std::map<int, std::string> oddCharacters(const std::string& text);

/// Parses the text once without building anything. Rejects text that is too large, nested too deeply for a recursive
/// parser, not YAML, or not exactly one document.
/// @param odd_characters  of the text, see oddCharacters(); an error names that of its line or of the last line before
/// @throws Error with place:line
void checkYaml(const std::string& text, const std::string& place, const YamlLimits& limits,
               const std::map<int, std::string>& odd_characters);

}  // namespace vibe
