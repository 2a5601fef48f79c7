#include "vibe_core/contact/tool_model.hpp"

#include <algorithm>

#include "common/turn.hpp"
#include "contact/inverse_kinematics.hpp"
#include "contact/tool_builder.hpp"
#include "contact/urdf_document.hpp"
#include "vibe_core/common/error.hpp"

namespace vibe {

ToolModel ToolModel::fromUrdf(const std::string& urdf_xml, const std::string& place) {
  const UrdfDocument document(urdf_xml, place);
  ToolBuilder parts(document, place);
  ToolModel model;
  model.link_names_ = std::move(parts.link_names);
  model.joints_ = std::move(parts.joints);
  model.shapes_ = std::move(parts.shapes);
  model.limits_ = parts.limits;
  model.shaft_stations_ = std::move(parts.shaft_stations);
  model.shaft_end_ = parts.shaft_end;
  return model;
}

int ToolModel::linkIndex(const std::string& name) const {
  for (int i = 0; i < linkCount(); ++i)
    if (link_names_[i] == name) return i;
  throw Error("The tool has no link '" + name + "'; its URDF must define it.");
}

ShaftBend ToolModel::shaftBend(const std::array<double, kJointCount>& inputs,
                               const ToolDisplacement& displacement) const {
  return ShaftBend(shaft_stations_, freeLength(inputs[Insertion] + displacement[Insertion]), displacement);
}

void ToolModel::forwardKinematics(const std::array<double, kJointCount>& inputs,
                                  std::vector<Eigen::Isometry3d>& link_poses) const {
  forwardKinematics(inputs, ToolDisplacement{}, link_poses);
}

void ToolModel::forwardKinematics(const std::array<double, kJointCount>& inputs, const ToolDisplacement& displacement,
                                  std::vector<Eigen::Isometry3d>& link_poses) const {
  const bool bent = std::any_of(displacement.begin() + kShaftDof, displacement.end(), [](double d) { return d != 0; });
  const ShaftBend bend(shaft_stations_, bent ? freeLength(inputs[Insertion] + displacement[Insertion]) : 0,
                       displacement);
  link_poses.resize(link_names_.size());
  link_poses[0].setIdentity();
  for (const ToolJoint& joint : joints_) {
    Eigen::Isometry3d& pose = link_poses[joint.child_link];
    pose = link_poses[joint.parent_link] * joint.origin;
    if (joint.type == ToolJoint::Type::Fixed) continue;
    if (joint.station >= 0) {
      if (bent) pose.rotate(rotationAbout(joint.axis, bend.angle(joint.station, joint.direction)));
      continue;
    }
    const double yielded = joint.input < kScopeJointCount ? displacement[joint.input] : 0;
    const double position = joint.multiplier * (inputs[joint.input] + yielded) + joint.offset;
    if (joint.type == ToolJoint::Type::Prismatic)
      pose.translate(position * joint.axis);
    else
      pose.rotate(rotationAbout(joint.axis, position));
  }
}

std::array<double, kJointCount> ToolModel::inverseKinematics(const Eigen::Isometry3d& target,
                                                             const std::array<double, kJointCount>& start) const {
  return InverseKinematics(*this, target).solve(start);
}

}  // namespace vibe
