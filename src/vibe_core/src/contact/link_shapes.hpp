#pragma once
#include <urdf_model/link.h>

#include <vector>

#include "vibe_core/contact/tool_model.hpp"

namespace vibe {

/// Position and rotation of a URDF <origin>.
Eigen::Isometry3d toIsometry(const urdf::Pose& pose);

/// The collision shapes of a link as Bullet shapes without rounding margin; the caller sets ToolShape::link. A cylinder
/// with a sphere of the same radius at each end becomes one capsule. The surface is the same, but a point inside is
/// then pushed out sideways and never through the end of the cylinder into the sphere.
/// @throws Error with the remainder of a sentence that begins with the link: the error and the remedy, no full stop
std::vector<ToolShape> makeShapes(const urdf::Link& link);

}  // namespace vibe
