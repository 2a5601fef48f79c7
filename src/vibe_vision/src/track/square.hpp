#pragma once

namespace vibe::vision {

inline double square(double x) {
  return x * x;
}

}  // namespace vibe::vision
