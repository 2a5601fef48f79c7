#include "geometry/auto_exposure.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::rviz_plugins {
namespace {

constexpr double kCloseEnough = 0.04;  // of the target: close enough to show the first picture [1]
constexpr int kTries = 4;              // of the first picture
constexpr double kFollow = 0.3;  // of what is missing, at most, from picture to picture; all of it would overshoot

/// Stops that are missing. The level is about the square root of the exposure below the shoulder.
double missing(double level) {
  return 2 * std::log2(AutoExposure::kTarget / std::max(level, 0.01));
}

}  // namespace

void AutoExposure::see(double level, double time) {
  const double passed = time - time_;
  const bool again = begun_ && lost_ && passed == 0;
  const bool fresh = !begun_ || passed < 0 || passed > kGap || again;
  tries_ = again ? tries_ + 1 : 0;
  double stops = missing(level);
  if (!fresh) stops = std::clamp(kFollow * stops, -kRate * passed, kRate * passed);
  gain_ = std::clamp(gain_ * std::exp2(stops), kMinGain, kMaxGain);
  lost_ = fresh && tries_ + 1 < kTries && std::abs(level / kTarget - 1) > kCloseEnough;
  begun_ = true;
  time_ = time;
}

}  // namespace vibe::rviz_plugins
