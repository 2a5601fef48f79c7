#pragma once
#include <Eigen/Geometry>
#include <cstdint>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe::python {

/// The memory of an image, row by row.
struct CastImage {
  int width, height;
  float* depth;            ///< (height, width), along the optical axis [m]; NaN: nothing
  std::int32_t* triangle;  ///< (height, width); -1: nothing
  float* normal;           ///< (height, width, 3), in the camera, towards it; null: not wanted
};

/// Casts a ray through the middle of every pixel of a pinhole camera and keeps the first triangle that it meets, from
/// either side; of several at one depth the one with the lowest number.
/// @param camera  pose in world; z is the optical axis, x to the right, y down
/// @param field_of_view  from the left to the right edge [rad]
void castRays(const SurfaceView& surface, const Eigen::Isometry3d& camera, double field_of_view, CastImage& image);

}  // namespace vibe::python
