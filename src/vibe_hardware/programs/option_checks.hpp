#pragma once
#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string>

namespace vibe::hardware {

/// Accepts finite numbers of at least 0.
inline CLI::Validator notNegative() {
  const auto check = [](const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const bool accepted = !text.empty() && *end == '\0' && std::isfinite(value) && value >= 0;
    return accepted ? std::string() : "'" + text + "' is not a number of at least 0";
  };
  return CLI::Validator(check, "");
}

/// Accepts the whole numbers of a std::uint64_t, in decimal digits.
inline CLI::Validator wholeNumber() {
  const auto check = [](const std::string& text) -> std::string {
    std::uint64_t value = 0;
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, value);
    if (end != last || error == std::errc::invalid_argument)
      return "'" + text + "' is not a whole number of at least 0";
    if (error == std::errc::result_out_of_range)
      return "'" + text + "' is too large; write at most " + std::to_string(std::numeric_limits<std::uint64_t>::max());
    return "";
  };
  return CLI::Validator(check, "");
}

}  // namespace vibe::hardware
