#pragma once
#include <urdf_model/link.h>

#include <vector>

#include "vibe_core/contact/tool_model.hpp"

namespace vibe {

/// Position and rotation of a URDF <origin>.
Eigen::Isometry3d toIsometry(const urdf::Pose& pose);

/// The collision shapes of a link as Bullet shapes without rounding margin; ToolShape::link is left to the caller.
/// A cylinder whose two ends carry spheres of its own radius becomes one capsule: the surface is the same, but a point
/// in it is then pushed out sideways and never through the cylinder's end into the sphere.
/// @throws Error with the rest of a sentence that begins with the link: what is wrong and the remedy, no full stop
std::vector<ToolShape> makeShapes(const urdf::Link& link);

}  // namespace vibe
