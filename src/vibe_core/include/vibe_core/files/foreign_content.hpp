#pragma once
#include <string>
#include <string_view>

namespace vibe {

/// What a file is that came in the place of another: a Git LFS pointer, an HTML page, an archive, text in UTF-16 or
/// nothing at all.
/// @param content  the file, or its first kilobyte
/// @returns a clause with the remedy, e.g. "is a web page (HTML); ...", or an empty text
std::string foreignContent(std::string_view content);

}  // namespace vibe
