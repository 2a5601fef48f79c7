#pragma once
#include <cstdio>
#include <string>

namespace vibe::vision {

inline std::string withDecimals(double value, int decimals) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

}  // namespace vibe::vision
