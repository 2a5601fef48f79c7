#include "vibe_render/geometry/endoscope_light.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::render {

namespace {

constexpr double kAhead = 0.5;                                         // light of a guide of strength 1 ahead
constexpr double kRadiation = 0.014387769;                             // second constant of Planck's law [m K]
constexpr std::array<double, 3> kWavelengths{610e-9, 550e-9, 465e-9};  // of red, green, blue [m]

/// Spectral radiance of a black body, but for a factor that depends on the wavelength alone.
double radiance(double wavelength, double temperature) {
  return 1 / std::expm1(kRadiation / (wavelength * temperature));
}

}  // namespace

Eigen::Vector3d lightColour(double temperature) {
  Eigen::Vector3d colour;
  for (int c = 0; c < 3; ++c) {
    const double wavelength = kWavelengths[static_cast<std::size_t>(c)];
    colour[c] = radiance(wavelength, temperature) / radiance(wavelength, EndoscopeLight::kBalanced);
  }
  return colour / colour[1];
}

Eigen::Vector2d coneOf(const EndoscopeLight& light, const LightGuide& guide) {
  return kAhead * guide.strength * Eigen::Vector2d(light.sideward, 1 - light.sideward);
}

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

}  // namespace vibe::render
