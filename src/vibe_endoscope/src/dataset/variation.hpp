#pragma once
#include <cstdint>

#include "sensor/sensor_model.hpp"
#include "vibe_graphics/geometry/endoscope_optics.hpp"
#include "vibe_graphics/geometry/mucosa_pattern.hpp"

namespace vibe::endoscope {

/// What differs between two endoscopes of the same kind, between two moments of their processors, and between the
/// mucosa of two stomachs of the same shape.
struct Variation {
  double field_of_view = 2.443461;      ///< [rad]
  double roll = 0, pitch = 0, yaw = 0;  ///< of the lens in its mount [rad]
  SensorStyle sensor;
  graphics::MucosaLook mucosa;
  graphics::EndoscopeLight light;
};

/// Draws a variation; the same seed gives the same one. Ranges are design choices; those with (log) are log-uniform.
/// Lens: field of view +- 5 degrees around `field_of_view`, roll +- 5 and pitch and yaw +- 2 degrees. Sensor: exposure
/// 0.7 to 1.4 (log), colour balance +- 10 %, vignetting 0.05 to 0.4, blur 0.3 to 0.9 px, distortion +- 0.03, full well
/// 2,000 to 12,000 electrons (log), read noise 0.001 to 0.006. Mucosa: patterns anywhere within 0.5 m, areae gastricae
/// 2 to 5 mm, paleness 0.8 to 1.25 (log), yellowness 0.92 to 1.09 (log), vessels 0.3 to 2 (log), wetness 0.6 to 1.6
/// (log), mucus -0.06 to 0.08. Light: each guide 2.8 to 3.8 mm beside and 0 to 1.25 mm above the lens, strength of the
/// right one against the left one 0.6 to 1.67 (log) with the same sum, light at right angles 0.15 to 0.45 of that
/// ahead, 4,800 to 7,000 K.
Variation variationOf(std::uint32_t seed, double field_of_view);

}  // namespace vibe::endoscope
