#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "vibe_core/contact/tool_model.hpp"
#include "vibe_core/solver/body_loads.hpp"

namespace vibe {

/// Derivative of the position of a point on a link with respect to the tool inputs: columns in the order of vibe::Joint
/// [m/m], [m/rad].
/// @param poses  of the links in any one frame, as from ToolModel::forwardKinematics(); the result is in that frame
/// @param point  in the same frame [m]
Eigen::Matrix<double, 3, kJointCount> pointJacobian(const ToolModel& tool, const std::vector<Eigen::Isometry3d>& poses,
                                                    int link, const Eigen::Vector3d& point);

/// Derivative of the position of a point on a link with respect to the tool's displacement: columns in the order of
/// ToolDisplacement [m/m], [m/rad], [m^2]. The first counts that the free length of a bent shaft changes.
/// @param bend  of the shaft, ToolModel::shaftBend()
Eigen::Matrix<double, 3, kYieldDofs> yieldJacobian(const ToolModel& tool, const std::vector<Eigen::Isometry3d>& poses,
                                                   const ShaftBend& bend, int link, const Eigen::Vector3d& point);

/// Generalised force on the tool's displacement of a force and a torque that act on a link.
/// @param point   at which the force acts, in the frame of the poses [m]
/// @param force   [N], @param torque  [N m]: in the same frame
YieldVector yieldForce(const ToolModel& tool, const std::vector<Eigen::Isometry3d>& poses, const ShaftBend& bend,
                       int link, const Eigen::Vector3d& point, const Eigen::Vector3d& force,
                       const Eigen::Vector3d& torque);

}  // namespace vibe
