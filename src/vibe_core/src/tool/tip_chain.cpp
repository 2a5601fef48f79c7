#include "tool/tip_chain.hpp"

#include <algorithm>
#include <limits>

#include "arithmetic/turn.hpp"

namespace vibe {

namespace {

bool turns(const ToolJoint& joint) {
  return joint.type == ToolJoint::Type::Revolute && joint.station < 0;
}

// The joints of the bending section share its angle.
bool turnAlike(const ToolJoint& a, const ToolJoint& b) {
  return turns(a) && turns(b) && a.input == b.input && a.multiplier == b.multiplier && a.offset == b.offset &&
         a.axis == b.axis;
}

double positionOf(const ToolJoint& joint, const TipChain::Inputs& inputs) {
  return joint.multiplier * inputs[joint.input] + joint.offset;
}

}  // namespace

TipChain::TipChain(const ToolModel& tool) {
  for (int link = tool.linkIndex("scope_tip"); link != 0; link = joints_.back()->parent_link)
    joints_.push_back(&tool.joints()[link - 1]);  // joint k has child link k + 1
  std::reverse(joints_.begin(), joints_.end());
  for (const ToolJoint* joint : joints_) {
    const auto first = std::find_if(joints_.begin(), joints_.end(),
                                    [joint](const ToolJoint* other) { return turnAlike(*joint, *other); });
    alike_.push_back(first == joints_.end() ? -1 : static_cast<int>(first - joints_.begin()));
    straight_.push_back(joint->origin.linear() == Eigen::Matrix3d::Identity());
  }
  rotation_.resize(joints_.size());
  placed_at_.fill(std::numeric_limits<double>::quiet_NaN());
  poses_.assign(joints_.size(), Eigen::Isometry3d::Identity());
}

void TipChain::turnAll(const Inputs& inputs) {
  for (int link = 0; link < count(); ++link)
    if (alike_[link] == link) rotation_[link] = rotationAbout(joint(link).axis, positionOf(joint(link), inputs));
}

const Eigen::Isometry3d& TipChain::place(const Inputs& inputs) {
  if (inputs == placed_at_) return tip();
  placed_at_ = inputs;
  turnAll(inputs);
  const Eigen::Isometry3d root = Eigen::Isometry3d::Identity();
  const Eigen::Isometry3d* parent = &root;
  for (int link = 0; link < count(); ++link) {
    const Eigen::Isometry3d& origin = joint(link).origin;
    Eigen::Isometry3d& pose = poses_[link];
    Eigen::Matrix3d turned = parent->linear();
    if (!straight_[link]) turned *= origin.linear();
    pose.translation() = parent->linear() * origin.translation() + parent->translation();
    if (alike_[link] >= 0)
      pose.linear().noalias() = turned * rotation_[alike_[link]];
    else
      pose.linear() = turned;
    if (joint(link).type == ToolJoint::Type::Prismatic)
      pose.translation() += turned * (positionOf(joint(link), inputs) * joint(link).axis);
    parent = &pose;
  }
  return tip();
}

}  // namespace vibe
