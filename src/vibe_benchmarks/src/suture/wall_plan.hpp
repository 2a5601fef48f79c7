#pragma once
#include <Eigen/Core>
#include <vector>

#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/geometry/stomach_axis.hpp"
#include "vibe_core/geometry/surface_view.hpp"
#include "vibe_core/geometry/triangle_tree.hpp"

namespace vibe::benchmarks {

/// A material point of the wall.
struct WallSpot {
  int triangle = -1;
  Eigen::Vector3d weight = Eigen::Vector3d::Zero();  ///< of its corners, sum 1
};
/// Its current position [m].
Eigen::Vector3d placeOf(const WallSpot& spot, const SurfaceView& wall);

/// Finds points on the body of a stomach from their distances to the greater curvature and to its distal end, measured
/// along the wall in its shape when the plan is made, like marks that an endoscopist sets before the first bite.
class WallPlan {
 public:
  /// @param wall  current positions of the organ's vertices; used only here and in at()
  /// @throws Error if the body of the organ has no greater curvature
  WallPlan(const Organ& organ, const SurfaceView& wall);

  /// Length of the greater curvature of the body [m].
  double length() const { return curve_length_.back(); }

  /// @param along   from the distal end of the body, towards the fundus, in [0, length()] [m]
  /// @param across  from the greater curvature, negative: towards the anterior wall [m]
  /// @throws Error if across reaches the lesser curvature
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

}  // namespace vibe::benchmarks
