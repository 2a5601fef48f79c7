#pragma once

#include <vector>

#include <Eigen/Core>

#include "vibe_core/suture/technique.hpp"

namespace vibe {

/// Places of the bites of a pattern on the flat wall, around its centre: x distal, y towards the front, in the order in
/// which they are made [m]. Every corner has a bite; the others are spread evenly over the sides.
/// @param length  of the pattern along the organ, @param width around it [m]
/// @throws Error for fewer bites than the pattern needs
std::vector<Eigen::Vector2d> suturePattern(Technique technique, int bites, double length, double width);

}  // namespace vibe
