#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "suture/wall_plan.hpp"

namespace vibe {

/// Where the sets of a procedure go: along the greater curvature of the body, distal to proximal, each across it from
/// the anterior to the posterior wall. Spacings of 15 to 20 mm are usual; all figures here are design choices.
struct SetLayout {
  std::string pattern =
      "u";  ///< "u" and "z": legs across joined by a bar along; "c": an arc, open to the anterior wall
  int sets = 6;
  int bites = 7;              ///< of a set: 4, or 7 (two bite vectors on each leg and on the bar)
  double half_width = 0.018;  ///< a leg reaches so far to both sides of the greater curvature [m]
  double share = 0.6;         ///< of the length that one set has along the organ between its first and last leg [1]
};

/// Bites of one pattern in the square [-1, 1] across (anterior to posterior) and [0, 1] along (distal to proximal).
/// @throws Error for another pattern or number of bites
std::vector<Eigen::Vector2d> patternBites(const std::string& pattern, int bites);

/// The bites of every set.
std::vector<std::vector<WallSpot>> planSets(const WallPlan& plan, const SetLayout& layout);

}  // namespace vibe
