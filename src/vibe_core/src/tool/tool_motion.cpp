#include "tool/tool_motion.hpp"

#include <algorithm>

#include <BulletCollision/CollisionShapes/btConvexShape.h>

namespace vibe {

std::array<double, kJointCount> ToolMotion::inputs(double fraction) const {
  std::array<double, kJointCount> inputs{};
  for (int i = 0; i < kJointCount; ++i) inputs[i] = start_[i] + fraction * (end_[i] - start_[i]);
  return inputs;
}

ToolDisplacement ToolMotion::displacement(double fraction) const {
  ToolDisplacement displacement = start_displacement_;
  for (int d = 0; d < kYieldDofs; ++d) displacement[d] += fraction * (end_displacement_[d] - start_displacement_[d]);
  return displacement;
}

void ToolMotion::stop(double fraction) {
  end_ = inputs(fraction);
  end_displacement_ = displacement(fraction);
}

void ToolMotion::linkPoses(double fraction, LinkPoses& at) const {
  const auto here = inputs(fraction);
  const ToolDisplacement displaced = displacement(fraction);
  if (!at.poses.empty() && at.inputs == here && at.displacement == displaced) return;
  tool_->forwardKinematics(here, displaced, at.poses);
  for (Eigen::Isometry3d& pose : at.poses) pose = base_ * pose;
  at.inputs = here;
  at.displacement = displaced;
}

double ToolMotion::travel(const std::vector<Eigen::Isometry3d>& from, const std::vector<Eigen::Isometry3d>& to) const {
  double farthest = 0;
  for (const ToolShape& shape : tool_->shapes()) {
    btVector3 lower, upper;
    shape.shape->getAabb(btTransform::getIdentity(), lower, upper);
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d local((corner & 1) != 0 ? upper.x() : lower.x(), (corner & 2) != 0 ? upper.y() : lower.y(),
                                  (corner & 4) != 0 ? upper.z() : lower.z());
      const Eigen::Vector3d p = shape.origin * local;
      farthest = std::max(farthest, (to[shape.link] * p - from[shape.link] * p).norm());
    }
  }
  return farthest;
}

namespace {

// How a point moves with the joint that carries a link. The motion of a joint changes neither its axis nor, if it is
// revolute, its origin.
Eigen::Vector3d jointMotion(const ToolJoint& joint, const Eigen::Isometry3d& pose, const Eigen::Vector3d& point) {
  const Eigen::Vector3d axis = pose.linear() * joint.axis;
  if (joint.type == ToolJoint::Type::Revolute) return axis.cross(point - pose.translation());
  return axis;
}

// How fast arm and hook turn with needle_driver [rad/m]: the pin moves with both, so that the parts of its motion along
// either bar are those of that bar's other end.
// @param way  of the needle's point per metre of the driver
double turnRate(const NeedleLinkage& linkage, const ToolJoint& joint, const std::vector<Eigen::Isometry3d>& poses,
                const Eigen::Vector3d& way) {
  const Eigen::Vector3d axis = poses[linkage.arm].linear() * Eigen::Vector3d(joint.axis);
  const Eigen::Vector3d pin = poses[linkage.arm_pin].translation();
  const Eigen::Vector3d arm = pin - poses[linkage.arm].translation(), hook = pin - poses[linkage.hook].translation();
  const double across = axis.cross(arm).dot(hook);  // 0 where the bars are in one line
  return (joint.child_link == linkage.arm ? way.dot(hook) : way.dot(arm)) / across;
}

double rateOf(const ToolModel& tool, const ToolJoint& joint, const std::vector<Eigen::Isometry3d>& poses) {
  const auto& linkage = tool.needleLinkage();
  if (!linkage || (joint.child_link != linkage->arm && joint.child_link != linkage->hook)) return joint.multiplier;
  const ToolJoint& needle = tool.joints()[static_cast<std::size_t>(tool.joints()[linkage->hook - 1].parent_link) - 1];
  return turnRate(*linkage, joint, poses, needle.multiplier * (poses[needle.child_link].linear() * needle.axis));
}

}  // namespace

Eigen::Matrix<double, 3, kJointCount> pointJacobian(const ToolModel& tool, const std::vector<Eigen::Isometry3d>& poses,
                                                    int link, const Eigen::Vector3d& point) {
  Eigen::Matrix<double, 3, kJointCount> jacobian = Eigen::Matrix<double, 3, kJointCount>::Zero();
  while (link > 0) {
    const ToolJoint& joint = tool.joints()[link - 1];  // the joint that carries the link
    if (joint.input >= 0)
      jacobian.col(joint.input) += rateOf(tool, joint, poses) * jointMotion(joint, poses[link], point);
    link = joint.parent_link;
  }
  return jacobian;
}

Eigen::Matrix<double, 3, kYieldDofs> yieldJacobian(const ToolModel& tool, const std::vector<Eigen::Isometry3d>& poses,
                                                   const ShaftBend& bend, int link, const Eigen::Vector3d& point) {
  Eigen::Matrix<double, 3, kYieldDofs> jacobian = Eigen::Matrix<double, 3, kYieldDofs>::Zero();
  while (link > 0) {
    const ToolJoint& joint = tool.joints()[link - 1];
    if (joint.station >= 0) {
      const Eigen::Vector3d moves = jointMotion(joint, poses[link], point);
      const ShaftBend::Share& share = bend.share(joint.station);
      const int dof = kShaftDof + 2 * joint.direction;
      jacobian.col(dof) += share.mean * moves;
      jacobian.col(dof + 1) += share.change * moves;
      jacobian.col(Insertion) += bend.angleRate(joint.station, joint.direction) * moves;
    } else if (joint.input >= 0 && joint.input < kScopeJointCount) {
      jacobian.col(joint.input) += joint.multiplier * jointMotion(joint, poses[link], point);
    }
    link = joint.parent_link;
  }
  return jacobian;
}

}  // namespace vibe
