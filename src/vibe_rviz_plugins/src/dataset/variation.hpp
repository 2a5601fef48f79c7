#pragma once
#include <cstdint>

#include "geometry/lens.hpp"
#include "sensor/sensor_model.hpp"

namespace vibe {

/// What differs between two endoscopes of the same kind and between two moments of their processors.
struct CameraVariation {
  double field_of_view = 2.443461;      ///< [rad]
  double roll = 0, pitch = 0, yaw = 0;  ///< of the lens in its mount [rad]
  SensorStyle sensor;
};

/// Draws a variation; the same seed gives the same one. Ranges are design choices: field of view +- 5 degrees around
/// `field_of_view`, roll +- 5 and pitch and yaw +- 2 degrees, exposure 0.7 to 1.4 (log-uniform), colour balance +- 10
/// %, vignetting 0.05 to 0.4, blur 0.3 to 0.9 px, distortion +- 0.03, full well 2,000 to 12,000 electrons
/// (log-uniform), read noise 0.001 to 0.006.
CameraVariation variationOf(std::uint32_t seed, double field_of_view);

}  // namespace vibe
