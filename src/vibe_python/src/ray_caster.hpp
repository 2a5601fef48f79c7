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

/// A pinhole: z is the optical axis, x to the right, y down; pixel k is seen through its middle, k + 0.5.
struct Lens {
  double focal;  ///< [pixels]
  double centre_x, centre_y;

  /// @param field_of_view  from the left to the right edge [rad]
  Lens(int width, int height, double field_of_view);
  /// Through the middle of a pixel, of depth 1.
  Eigen::Vector3d ray(int column, int row) const {
    return {(column + 0.5 - centre_x) / focal, (row + 0.5 - centre_y) / focal, 1};
  }
};

/// Casts a ray through the middle of every pixel of a pinhole camera and keeps the first triangle that it meets, from
/// either side; of several at one depth the one with the lowest number.
/// @param camera  pose in world; z is the optical axis, x to the right, y down
/// @param field_of_view  from the left to the right edge [rad]
void castRays(const SurfaceView& surface, const Eigen::Isometry3d& camera, double field_of_view, CastImage& image);

}  // namespace vibe::python
