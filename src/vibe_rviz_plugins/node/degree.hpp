#pragma once
#include <cmath>

namespace vibe {

constexpr double kDegree = M_PI / 180;  ///< [rad]

}  // namespace vibe
