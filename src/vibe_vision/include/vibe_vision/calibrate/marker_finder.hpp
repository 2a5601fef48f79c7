#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "vibe_vision/config/vision_config.hpp"
#include "vibe_vision/image/frame.hpp"
#include "vibe_vision/marker/marker_design.hpp"

namespace vibe::vision {

/// Where a marker roughly is: within a pixel, 2 % of its size and a few degrees.
struct MarkerSighting {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< centre, as seen (distorted) [px]
  Eigen::Vector2d direction =
      Eigen::Vector2d::UnitX();  ///< of +u of a sleeve; of a ring always x; unit vector in the image
  double pixels_per_metre = 0;   ///< from the size at which it is seen [px/m]
  double score = 0;              ///< correlation coefficient, up to 1
};

/// What to look for.
struct MarkerSearch {
  double lowest_scale = 4e3, highest_scale = 25e3;  ///< [px/m]
};

/// Finds a marker anywhere in an image, at any angle, without a calibration: correlation with its picture over angles
/// and sizes. Slow (seconds for the first image); the next images are searched near the angle and size of the last.
/// A small picture resembles something everywhere, and a large one something of the background: over a wide range of
/// sizes the best correlation need not be the marker. So a few places of every size are kept, and what knows the marker
/// better may choose among them.
class MarkerFinder {
 public:
  /// @throws Error unless both scales are above 0 and the lowest is not above the highest
  MarkerFinder(const MarkerDesign& design, const MarkerSearch& search);
  ~MarkerFinder();
  MarkerFinder(const MarkerFinder&) = delete;
  MarkerFinder& operator=(const MarkerFinder&) = delete;

  /// Whether a place is that of the marker.
  using Confirm = std::function<bool(const MarkerSighting&)>;
  /// @param confirm  whether a place is the marker: asked from the best place on, until it says so
  /// @return the place that is confirmed; if none is, the one that looks most alike; nothing if none looks enough like
  ///         the marker
  std::optional<MarkerSighting> find(const ImageView& image, const Confirm& confirm);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The marker of an instrument in one image.
struct LocatedMarker {
  bool found = false;                               ///< false: the numbers below say nothing
  std::string problem;                              ///< why it was not found; a sentence
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< centre, undistorted [px]
  double pixels_per_metre = 0;                      ///< from the size at which it is seen [px/m]
  double rotation = 0;                              ///< of a sleeve [rad]
  double ink = 0;                                   ///< InstrumentConfig::ink as the image shows it [m]
};

struct LocatedMarkers {
  std::vector<LocatedMarker> markers;  ///< one per image
  /// Where positive slide is as a sleeve shows it: a unit vector in the undistorted image; zero for a ring.
  Eigen::Vector2d direction = Eigen::Vector2d::Zero();
  double ink = 0;  ///< median of those of the images [m]
};

/// Finds an instrument's marker in images that were taken along its axis, without a calibrated axis: a search of the
/// whole images gives a rough axis, on which the tracker then measures to a fraction of a pixel.
/// @param config  its camera must be calibrated; its axis is not used
/// @throws Error if the images are of another size than the camera, or the marker was found in fewer than two, or it
///         did not move
LocatedMarkers locateMarkers(const VisionConfig& config, std::size_t instrument, const std::vector<Frame>& images,
                             const MarkerSearch& search);

}  // namespace vibe::vision
