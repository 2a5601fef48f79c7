#pragma once
#include <Eigen/Geometry>
#include <string>

#include "session.hpp"

namespace vibe::python {

/// Pose of a link of the tool in world, of the present state.
/// @throws Error without a scope
Eigen::Isometry3d linkPose(const Model& model, const State& state, int link);
/// Force and torque of the tissue on the tool about the origin of scope_tip, in scope_tip [N], [N m].
Eigen::Matrix<double, 6, 1> wrenchOf(const State& state);
/// @throws Error without a scope
void needTool(const Model& model);

}  // namespace vibe::python
