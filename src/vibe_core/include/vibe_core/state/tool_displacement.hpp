#pragma once

#include <array>

namespace vibe {

/// Degrees of freedom of a tool that gives way. The first four are those of the scope's joints, in the order of
/// vibe::Joint; then the curvature of the shaft between its entry and the bending section, up and left, each as a mean
/// and a change: at the end of the shaft the curvature is mean + change, at the entry mean - change, linear between.
constexpr int kYieldDofs = 8;
constexpr int kShaftDof = 4;  ///< the first of the shaft: mean up, change up, mean left, change left

/// How far the endoscope is from what the hand commands: [m], [rad], [rad], [rad], then [1/m]. Zero: not at all.
using ToolDisplacement = std::array<double, kYieldDofs>;

}  // namespace vibe
