#pragma once
#include <cmath>

namespace vibe::rviz_plugins {

constexpr double kDegree = M_PI / 180;  ///< [rad]

}  // namespace vibe::rviz_plugins
