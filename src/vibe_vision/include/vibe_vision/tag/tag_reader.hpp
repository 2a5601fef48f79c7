#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "vibe_vision/config/vision_config.hpp"
#include "vibe_vision/image/frame.hpp"
#include "vibe_vision/marker/marker_design.hpp"

namespace vibe::vision {

/// Corners of the black border, around it [px of the picture that was searched]; the centres of pixels are integers.
using TagCorners = std::array<Eigen::Vector2d, 4>;

/// The cells of a tag as its library draws it, row by row, border included; 1: white, 0: black.
std::vector<std::uint8_t> tagPicture(const TagDesign& tag);

/// Finds one tag by the detector of its library: libapriltag with refined edges and without decimation, in one thread;
/// OpenCV's aruco with sub-pixel corners, whose window stays within a cell, since a larger one finds corners of the
/// cells inside. It allocates memory. Not thread-safe; use one per thread.
class TagReader {
 public:
  /// @param pixels_per_metre  at which the tag is seen about [px/m]
  TagReader(const TagDesign& tag, double pixels_per_metre);
  ~TagReader();
  TagReader(TagReader&&) noexcept;             ///< leaves the other unusable
  TagReader& operator=(TagReader&&) noexcept;  ///< the same

  /// All tags with the number that is looked for.
  std::vector<TagCorners> find(const ImageView& view);

 private:
  class Detector;
  class AprilTagDetector;
  class ArucoDetector;
  std::unique_ptr<Detector> detector_;
};

/// Where a tag is, from its four corners: the affine picture of a square that fits them best.
struct TagPlace {
  Eigen::Vector2d centre;       ///< undistorted [px]
  Eigen::Matrix2d picture;      ///< of the tag's unit vectors [px/m]
  double pixels_per_metre = 0;  ///< square root of the area [px/m]
  double misfit = 0;            ///< what remains at each corner, in both directions together [px]

  /// @param shift  of the picture that was searched, in the full image [px]. @param side  of the tag [m]
  static TagPlace of(const CameraModel& camera, const TagCorners& corners, const Eigen::Vector2d& shift, double side);
};

}  // namespace vibe::vision
