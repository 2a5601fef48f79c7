#pragma once
#include <Eigen/Core>
#include <vector>

#include "geometry/triangle_tree.hpp"
#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/geometry/stomach_axis.hpp"
#include "vibe_core/geometry/surface_view.hpp"

namespace vibe {

/// A place of the wall that stays with the tissue.
struct WallSpot {
  int triangle = -1;
  Eigen::Vector3d weight = Eigen::Vector3d::Zero();  ///< of its corners, sum 1
};
/// Where it is now [m].
Eigen::Vector3d placeOf(const WallSpot& spot, const SurfaceView& wall);

/// Finds places on the body of a stomach by how far they lie from the greater curvature and from its distal end, along
/// the wall as it is when the plan is made: what an endoscopist marks before the first bite.
class WallPlan {
 public:
  /// @param wall  present positions of the organ's vertices; used only here and in at()
  /// @throws Error if the organ has no greater curvature of a body
  WallPlan(const Organ& organ, const SurfaceView& wall);

  /// Of the body's greater curvature [m].
  double length() const { return curve_length_.back(); }

  /// @param along   from the distal end of the body, towards the fundus, in [0, length()] [m]
  /// @param across  from the greater curvature, negative: towards the anterior wall [m]
  /// @throws Error if across leads round to the lesser curvature
  WallSpot at(double along, double across) const;

 private:
  WallSpot spotAt(double axis_length, double angle) const;
  double axisLengthAt(double along) const;

  StomachAxis axis_;
  TriangleTree rest_;
  SurfaceView wall_;
  std::vector<double> curve_axis_;    // place along the axis of samples of the greater curvature, distal first [m]
  std::vector<double> curve_length_;  // from the distal end along the wall [m]
};

}  // namespace vibe
