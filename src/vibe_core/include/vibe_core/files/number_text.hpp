#pragma once

#include <charconv>
#include <string>
#include <system_error>

namespace vibe {

/// std::from_chars(begin, end, value) for double, which libstdc++ has from version 11 on: the longest number in decimal
/// digits at `begin`, without white space and without a leading plus, whatever the locale is.
/// @return where the number ends, and std::errc::invalid_argument where there is none, std::errc::result_out_of_range
///         where no double holds it; `value` is set without an error only
std::from_chars_result readReal(const char* begin, const char* end, double& value);

/// The shortest text that reads back as the same finite number, as std::to_chars gives it, or, with a library that has
/// none for double, one of the same digits in another form.
std::string shortestText(double value);

/// What std::printf would print, as a text of any length.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* pattern, ...);

}  // namespace vibe
