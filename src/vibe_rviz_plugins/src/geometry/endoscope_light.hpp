#pragma once
#include <Eigen/Core>
#include <array>

namespace vibe::rviz_plugins {

/// The end of a bundle of fibres beside the lens.
struct LightGuide {
  double right, up;     ///< of the lens, as the picture shows right and up [m]
  double strength = 1;  ///< of its light [1]
};

/// The light of an endoscope. The defaults are that of the live view.
struct EndoscopeLight {
  std::array<LightGuide, 2> guides{{{0.0035, 0.0012}, {-0.0035, 0.0012}}};  ///< a tip of 9.8 mm holds them
  double sideward = 0.3;                     ///< light of a guide at right angles, as a part of its light ahead
  double temperature = 5800;                 ///< of the colour of the light [K]
  static constexpr double kBalanced = 5800;  ///< for which the processor shows white as white [K]
};

/// Red, green and blue of a white wall in light of this temperature (Planck 1901), when white is balanced for
/// EndoscopeLight::kBalanced. Green is 1.
/// @param temperature  above 1,000 K
Eigen::Vector3d lightColour(double temperature);

/// What the guide shines at right angles (x), and how much more ahead (y): its light in the direction z is x + y z. The
/// guides of the default have 0.15 and 0.35.
Eigen::Vector2d coneOf(const EndoscopeLight& light, const LightGuide& guide);

}  // namespace vibe::rviz_plugins
