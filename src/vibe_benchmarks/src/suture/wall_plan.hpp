#pragma once

#include <vector>

#include <Eigen/Core>

#include "vibe_core/geometry/anatomical_map.hpp"
#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe::benchmarks {

/// Its current position [m].
Eigen::Vector3d placeOf(const WallPoint& point, const SurfaceView& wall);

/// Finds points on the body of a stomach from their distances to the greater curvature and to its distal end, measured
/// along the wall in its shape when the plan is made, like marks that an endoscopist sets before the first bite. They
/// are those of its anatomical coordinates, whatever its mesh.
class WallPlan {
 public:
  /// @param wall  current positions of the organ's vertices
  /// @throws Error as AnatomicalMap, or if the body has no greater curvature
  WallPlan(const Organ& organ, const SurfaceView& wall);

  /// Length of the greater curvature of the body [m].
  double length() const { return curve_length_.back(); }

  /// @param along   from the distal end of the body, towards the fundus, in [0, length()] [m]
  /// @param across  from the greater curvature, negative: towards the anterior wall [m]
  /// @throws Error if across reaches the lesser curvature
  WallPoint at(double along, double across) const;

 private:
  AnatomicalMap map_;
  std::vector<double> curve_axis_;    // place along the axis of samples of the greater curvature, distal first
  std::vector<double> curve_length_;  // from the distal end along the wall [m]
};

/// Placement of the sets of a procedure: along the greater curvature of the body, distal to proximal, each across it
/// from the anterior to the posterior wall. Spacings of 15 to 20 mm are usual; all values here are design choices.
struct SetLayout {
  int sets = 6;
  int bites = 7;              ///< per set: 4, or 7 (two bite vectors on each leg and on the bar)
  double half_width = 0.018;  ///< extent of a leg to both sides of the greater curvature [m]
  double share =
      0.6;  ///< length of a set along the organ from first to last leg, relative to the length available per set
};

/// Bites of a U, legs across joined by a bar along, in the square [-1, 1] across (anterior to posterior) and [0, 1]
/// along (distal to proximal).
/// @throws Error for another number of bites than 4, 7, 10, ...
std::vector<Eigen::Vector2d> bitesOfU(int bites);

/// The bites of every set.
std::vector<std::vector<WallPoint>> planSets(const WallPlan& plan, const SetLayout& layout);

}  // namespace vibe::benchmarks
