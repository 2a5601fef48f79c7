#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>

#include "vibe_vision/image/frame.hpp"
#include "vibe_vision/marker/marker_design.hpp"

namespace vibe::vision {

/// Where a marker roughly is: within a pixel, 2 % of its size and a few degrees.
struct MarkerSighting {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();       ///< centre, as seen (distorted) [px]
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  ///< of +u of a sleeve; of a ring always x
  double pixels_per_metre = 0;
  double score = 0;  ///< correlation coefficient, up to 1
};

/// What to look for.
struct MarkerSearch {
  double lowest_scale = 4e3, highest_scale = 25e3;  ///< [px/m]
};

/// Finds a marker anywhere in an image, at any angle, without a calibration: correlation with its picture over angles
/// and sizes. Slow (seconds for the first image); the next images are searched near the angle and size of the last.
class MarkerFinder {
 public:
  MarkerFinder(const MarkerDesign& design, const MarkerSearch& search);
  ~MarkerFinder();
  MarkerFinder(const MarkerFinder&) = delete;
  MarkerFinder& operator=(const MarkerFinder&) = delete;

  /// @return nothing if nothing looks enough like the marker
  std::optional<MarkerSighting> find(const ImageView& image);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vibe::vision
