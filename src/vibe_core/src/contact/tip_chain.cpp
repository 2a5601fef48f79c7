#include "contact/tip_chain.hpp"

#include <algorithm>

#include "common/turn.hpp"

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
  }
  rotation_.resize(joints_.size());
  poses_.resize(joints_.size());
}

void TipChain::turnAll(const Inputs& inputs) {
  for (int link = 0; link < count(); ++link)
    if (alike_[link] == link) rotation_[link] = rotationAbout(joint(link).axis, positionOf(joint(link), inputs));
}

const Eigen::Isometry3d& TipChain::place(const Inputs& inputs) {
  turnAll(inputs);
  Eigen::Isometry3d parent = Eigen::Isometry3d::Identity();
  for (int link = 0; link < count(); ++link) {
    Eigen::Isometry3d& pose = poses_[link];
    pose = parent * joint(link).origin;
    if (alike_[link] >= 0)
      pose.rotate(rotation_[alike_[link]]);
    else if (joint(link).type == ToolJoint::Type::Prismatic)
      pose.translate(positionOf(joint(link), inputs) * joint(link).axis);
    parent = pose;
  }
  return tip();
}

}  // namespace vibe
