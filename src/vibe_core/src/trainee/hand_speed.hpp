#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "vibe_core/contact/tool_model.hpp"

namespace vibe {

/// Mean speeds of an experienced operator's hand per joint, design choice [m/s], [rad/s].
constexpr std::array<double, kJointCount> kHandSpeed{0.04, 1.2, 1.2, 1.2, 0.025, 12.5, 0.05};
constexpr double kPeakOverMean = 1.875;  ///< of the speed of a minimum-jerk movement (Flash & Hogan 1985)

/// Time of a motion of several joints at once, within the tool's speeds [s].
inline double durationOfMotion(const std::array<double, kJointCount>& from, const std::array<double, kJointCount>& to,
                               double pace, const std::array<JointLimits, kJointCount>& limits) {
  double time = 0;
  for (int j = 0; j < kJointCount; ++j) {
    const double way = std::abs(to[j] - from[j]);
    time = std::max({time, way / (pace * kHandSpeed[j]), kPeakOverMean * way / limits[j].velocity});
  }
  return time;
}

}  // namespace vibe
