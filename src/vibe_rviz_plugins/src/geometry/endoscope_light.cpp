#include "geometry/endoscope_light.hpp"

#include <cmath>

namespace vibe::rviz_plugins {
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

}  // namespace vibe::rviz_plugins
