#pragma once
#include <algorithm>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vibe {

/// The lines of a text, which may end with LF, CR LF or CR. A mark of UTF-8 at the beginning is no part of the first.
class TextLines {
 public:
  explicit TextLines(std::string_view text) : text_(text) {
    if (text_.substr(0, 3) == "\xef\xbb\xbf") place_ = 3;
  }

  /// Goes to the next line, at first to the first.
  bool next() {
    if (place_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find_first_of("\r\n", place_), text_.size());
    line_ = text_.substr(place_, end - place_);
    place_ = end + (text_.substr(end, 2) == "\r\n" ? 2 : 1);
    ++number_;
    return true;
  }

  std::string_view line() const { return line_; }
  int number() const { return number_; }  ///< of the line, from 1

 private:
  std::string_view text_, line_;
  std::size_t place_ = 0;
  int number_ = 0;
};

/// In small letters of ASCII.
std::string lowered(std::string_view word);

/// A number of a binary file, from bytes in little-endian order like that of the supported processors.
template <class Number>
double littleEndian(const char* bytes) {
  Number value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

/// The words of a line between blanks and tabs.
std::vector<std::string_view> wordsOf(std::string_view line);

/// A number with a decimal point, whatever the locale; also "nan" and "inf". One too small for a double is 0, one too
/// large is infinite.
std::optional<double> realOf(std::string_view word);

/// "line 12: '1,5' is not a number ..." with the remedy
std::string noNumber(int line, std::string_view word);

/// A word of a file between quotation marks for an error message: in ASCII and not long.
std::string shown(std::string_view word);

}  // namespace vibe
