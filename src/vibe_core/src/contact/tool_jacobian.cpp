#include "contact/tool_jacobian.hpp"

namespace vibe {

Eigen::Matrix<double, 3, kJointCount> pointJacobian(const ToolModel& tool, const std::vector<Eigen::Isometry3d>& poses,
                                                    int link, const Eigen::Vector3d& point) {
  Eigen::Matrix<double, 3, kJointCount> jacobian = Eigen::Matrix<double, 3, kJointCount>::Zero();
  while (link > 0) {
    const ToolJoint& joint = tool.joints()[link - 1];  // the joint that carries the link
    if (joint.input >= 0) {
      // the motion of a joint changes neither its axis nor, if it is revolute, its origin
      const Eigen::Vector3d axis = poses[link].linear() * joint.axis;
      const bool turns = joint.type == ToolJoint::Type::Revolute;
      const Eigen::Vector3d moves = turns ? axis.cross(point - poses[link].translation()).eval() : axis;
      jacobian.col(joint.input) += joint.multiplier * moves;
    }
    link = joint.parent_link;
  }
  return jacobian;
}

}  // namespace vibe
