#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "vibe_vision/calibrate/marker_finder.hpp"
#include "vibe_vision/config/vision_config.hpp"

namespace vibe::vision {

/// The marker of an instrument in one image.
struct LocatedMarker {
  bool found = false;
  std::string problem;                              ///< why it was not found; a sentence
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< centre, undistorted [px]
  double pixels_per_metre = 0;                      ///< from the size at which it is seen
  double rotation = 0;                              ///< of a sleeve [rad]
};

struct LocatedMarkers {
  std::vector<LocatedMarker> markers;  ///< one per image
  /// Where positive slide is as a sleeve shows it, undistorted; zero for a ring.
  Eigen::Vector2d direction = Eigen::Vector2d::Zero();
};

/// Finds an instrument's marker in images that were taken along its axis, without a calibrated axis: a search of the
/// whole images gives a rough axis, on which the tracker then measures to a fraction of a pixel.
/// @param config  its camera must be calibrated; its axis is not used
/// @throws Error if the images are of another size than the camera, or the marker was found in fewer than two, or it
///         did not move
LocatedMarkers locateMarkers(const VisionConfig& config, std::size_t instrument, const std::vector<Frame>& images,
                             const MarkerSearch& search);

}  // namespace vibe::vision
