#pragma once
#include <string>

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

}  // namespace vibe
