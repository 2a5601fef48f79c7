#pragma once
#include <string>

namespace vibe {

/// A text from a user's file made fit for an error message: control characters become '?', and what goes beyond
/// `longest` bytes becomes "...".
inline std::string printable(const std::string& text, std::size_t longest) {
  std::string result = text.substr(0, longest);
  for (char& c : result) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return text.size() > longest ? result + "..." : result;
}

}  // namespace vibe
