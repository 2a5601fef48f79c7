#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "suture/wall_plan.hpp"

namespace vibe::benchmarks {

/// Placement of the sets of a procedure: along the greater curvature of the body, distal to proximal, each across it
/// from the anterior to the posterior wall. Spacings of 15 to 20 mm are usual; all values here are design choices.
struct SetLayout {
  std::string pattern =
      "u";  ///< "u" and "z": legs across joined by a bar along; "c": an arc, open to the anterior wall
  int sets = 6;
  int bites = 7;              ///< per set: 4, or 7 (two bite vectors on each leg and on the bar)
  double half_width = 0.018;  ///< extent of a leg to both sides of the greater curvature [m]
  double share =
      0.6;  ///< length of a set along the organ from first to last leg, relative to the length available per set [1]
};

/// Bites of one pattern in the square [-1, 1] across (anterior to posterior) and [0, 1] along (distal to proximal).
/// @throws Error for another pattern or number of bites
std::vector<Eigen::Vector2d> patternBites(const std::string& pattern, int bites);

/// The bites of every set.
std::vector<std::vector<WallSpot>> planSets(const WallPlan& plan, const SetLayout& layout);

}  // namespace vibe::benchmarks
