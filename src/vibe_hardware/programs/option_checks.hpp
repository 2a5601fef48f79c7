#pragma once
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>
#include <string>

namespace vibe {

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

}  // namespace vibe
