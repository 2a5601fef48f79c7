#include "vibe_core/files/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <limits>
#include <locale>
#include <sstream>
#include <string>
#include <string_view>

#include "files/portable_numbers.hpp"

namespace vibe {

namespace {

const char* digitsFrom(const char* at, const char* end) {
  while (at != end && *at >= '0' && *at <= '9') ++at;
  return at;
}

/// The end of the longest number in digits at `begin`; `begin` where there is none.
/// @param significant  out: one of the digits is not 0
const char* endOfNumber(const char* begin, const char* end, bool& significant) {
  const char* const whole = begin != end && *begin == '-' ? begin + 1 : begin;
  const char* at = digitsFrom(whole, end);
  std::ptrdiff_t digits = at - whole;
  if (at != end && *at == '.') {
    const char* const after = digitsFrom(at + 1, end);
    digits += after - at - 1;
    if (digits > 0) at = after;
  }
  if (digits == 0) return begin;
  significant = std::any_of(whole, at, [](char c) { return c > '0'; });
  if (at == end || (*at != 'e' && *at != 'E')) return at;
  const char* exponent = at + 1;
  if (exponent != end && (*exponent == '+' || *exponent == '-')) ++exponent;
  const char* const after = digitsFrom(exponent, end);
  return after == exponent ? at : after;
}

/// "inf", "infinity" and "nan", in letters of any case
std::from_chars_result readWord(const char* begin, const char* end, double& value) {
  const bool negative = begin != end && *begin == '-';
  const char* const start = negative ? begin + 1 : begin;
  for (const std::string_view word : {"infinity", "inf", "nan"}) {
    if (end - start < static_cast<std::ptrdiff_t>(word.size())) continue;
    const char* const stop = start + word.size();
    if (!std::equal(start, stop, word.begin(), [](char a, char b) { return (a | 0x20) == b; })) continue;
    const double size = word == "nan" ? std::nan("") : std::numeric_limits<double>::infinity();
    value = negative ? -size : size;
    return {stop, std::errc()};
  }
  return {begin, std::errc::invalid_argument};
}

}  // namespace

namespace portable {

std::from_chars_result readReal(const char* begin, const char* end, double& value) {
  bool significant = false;
  const char* const stop = endOfNumber(begin, end, significant);
  if (stop == begin) return readWord(begin, end, value);
  // a stream with the classic locale rounds as strtod() does and knows no other locale
  std::istringstream in(std::string(begin, stop));
  in.imbue(std::locale::classic());
  double read = 0;
  in >> read;
  const bool held = !in.fail() && std::isfinite(read) && (read != 0 || !significant);
  if (held) value = read;
  return {stop, held ? std::errc() : std::errc::result_out_of_range};
}

std::string shortestText(double value) {
  std::string text;
  double back = 0;
  for (int digits = 1; digits <= std::numeric_limits<double>::max_digits10; ++digits) {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out.precision(digits);
    out << value;
    text = out.str();
    portable::readReal(text.data(), text.data() + text.size(), back);
    if (back == value) break;
  }
  return text;
}

}  // namespace portable

#ifdef __cpp_lib_to_chars

std::from_chars_result readReal(const char* begin, const char* end, double& value) {
  return std::from_chars(begin, end, value);
}

std::string shortestText(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

#else

std::from_chars_result readReal(const char* begin, const char* end, double& value) {
  return portable::readReal(begin, end, value);
}

std::string shortestText(double value) {
  return portable::shortestText(value);
}

#endif

std::string formatted(const char* pattern, ...) {
  va_list arguments, again;
  va_start(arguments, pattern);
  va_copy(again, arguments);
  std::string text(static_cast<std::size_t>(std::max(0, std::vsnprintf(nullptr, 0, pattern, again))), ' ');
  va_end(again);
  std::vsnprintf(text.data(), text.size() + 1, pattern, arguments);
  va_end(arguments);
  return text;
}

}  // namespace vibe
