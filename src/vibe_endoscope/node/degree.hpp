#pragma once
#include <cmath>

namespace vibe::endoscope {

constexpr double kDegree = M_PI / 180;  ///< [rad]

}  // namespace vibe::endoscope
