#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "vibe_core/contact/tool_model.hpp"

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

}  // namespace vibe
