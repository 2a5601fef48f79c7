#pragma once

#include <Eigen/Core>

#include "vibe_vision/config/vision_config.hpp"
#include "vibe_vision/tag/tag_reader.hpp"

namespace vibe::vision {

/// Where a tag is, from its four corners: the affine picture of a square that fits them best.
struct TagPlace {
  Eigen::Vector2d centre;       ///< undistorted [px]
  Eigen::Matrix2d picture;      ///< of the tag's unit vectors [px/m]
  double pixels_per_metre = 0;  ///< square root of the area
  double misfit = 0;            ///< what remains at each corner, in both directions together [px]

  /// @param shift  of the picture that was searched, in the full image [px]. @param side  of the tag [m]
  static TagPlace of(const CameraModel& camera, const TagCorners& corners, const Eigen::Vector2d& shift, double side);
};

}  // namespace vibe::vision
