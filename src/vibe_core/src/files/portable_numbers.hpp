#pragma once

#include <charconv>
#include <string>

/// readReal() and shortestText() for standard libraries that have neither std::from_chars nor std::to_chars of double.
/// They are compiled everywhere, so that tests can compare them.
namespace vibe::portable {

std::from_chars_result readReal(const char* begin, const char* end, double& value);
std::string shortestText(double value);

}  // namespace vibe::portable
