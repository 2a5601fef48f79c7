#pragma once

namespace vibe {

inline double square(double x) {
  return x * x;
}

}  // namespace vibe
