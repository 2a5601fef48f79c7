#include "vibe_core/tool/tool_model.hpp"

#include <algorithm>
#include <cstddef>

#include "arithmetic/turn.hpp"
#include "tool/kinematics.hpp"
#include "tool/tool_builder.hpp"
#include "tool/urdf_document.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

// Adds the part of one interval between two stations to the share of the station at which the hat is 1. Simpson's rule
// is exact for these products of two linear functions.
// @param begin, end  of the interval [m]
// @param from, to    the hat at the two
void addInterval(double begin, double end, double from, double to, double length, ShaftBend::Share& share) {
  const double reach = std::min(end, length) - begin;
  if (!(reach > 0)) return;
  for (const auto& [place, weight] : {std::pair{0.0, 1.0 / 6}, {0.5, 4.0 / 6}, {1.0, 1.0 / 6}}) {
    const double at = begin + place * reach;
    const double hat = from + (to - from) * (at - begin) / (end - begin);
    share.mean += weight * reach * hat;
    share.change += weight * reach * hat * (1 - 2 * at / length);
    share.change_rate += weight * reach * hat * 2 * at / (length * length);
  }
  if (!(length < end)) return;
  const double last = from + (to - from) * (length - begin) / (end - begin);  // at the entry, which moves
  share.mean_rate += last;
  share.change_rate -= last;
}

}  // namespace

ShaftBend::ShaftBend(const std::vector<double>& stations, double free_length, const ToolDisplacement& displacement)
    : displacement_(displacement) {
  constexpr double kFarAway = 1e3;  // the last station takes all that lies behind it [m]
  if (!(free_length > 0)) return;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const double here = stations[i];
    if (i > 0) addInterval(stations[i - 1], here, 0, 1, free_length, shares_[i]);
    const bool last = i + 1 == stations.size();
    addInterval(here, last ? kFarAway : stations[i + 1], 1, last ? 1 : 0, free_length, shares_[i]);
  }
}

double ShaftBend::angle(int station, int direction) const {
  const std::size_t dof = static_cast<std::size_t>(kShaftDof + 2 * direction);
  return share(station).mean * displacement_[dof] + share(station).change * displacement_[dof + 1];
}

double ShaftBend::angleRate(int station, int direction) const {
  const std::size_t dof = static_cast<std::size_t>(kShaftDof + 2 * direction);
  return share(station).mean_rate * displacement_[dof] + share(station).change_rate * displacement_[dof + 1];
}

ToolModel ToolModel::fromUrdf(const std::string& urdf_xml, const std::string& place, NeedleArm arm) {
  const UrdfDocument document(urdf_xml, place);
  ToolBuilder parts(document, place);
  ToolModel model;
  model.link_names_ = std::move(parts.link_names);
  model.joints_ = std::move(parts.joints);
  model.shapes_ = std::move(parts.shapes);
  model.meshes_ = std::move(parts.meshes);
  model.limits_ = parts.limits;
  model.shaft_stations_ = std::move(parts.shaft_stations);
  model.shaft_end_ = parts.shaft_end;
  model.setArm(arm);
  return model;
}

void ToolModel::setArm(NeedleArm arm) {
  const auto linkOf = [this](const char* joint) {
    const ToolJoint* const found = findJoint(*this, joint);
    return found == nullptr ? -1 : found->child_link;
  };
  const NeedleLinkage linkage{linkOf("needle_arm_hinge"),     linkOf("needle_hook_turn"),
                              linkOf("needle_arm_pin_mount"), linkOf("needle_hook_pin_mount"),
                              limits_[NeedleDriver].lower,    limits_[NeedleDriver].upper};
  if (!vibe::needleLinkage(*this, linkage.lower)) return;
  if (arm == NeedleArm::Body) {
    linkage_ = linkage;
    return;
  }
  const auto drawn = [&](const ToolShape& shape) { return shape.link == linkage.arm || shape.link == linkage.hook; };
  shapes_.erase(std::remove_if(shapes_.begin(), shapes_.end(), drawn), shapes_.end());
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
  const std::optional<LinkageTurns> turns = linkage_ ? vibe::needleLinkage(*this, inputs[NeedleDriver]) : std::nullopt;
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
    double position = joint.multiplier * (inputs[joint.input] + yielded) + joint.offset;
    if (turns && joint.child_link == linkage_->arm) position = turns->arm;
    if (turns && joint.child_link == linkage_->hook) position = turns->hook;
    if (joint.type == ToolJoint::Type::Prismatic)
      pose.translate(position * joint.axis);
    else
      pose.rotate(rotationAbout(joint.axis, position));
  }
}

std::array<double, kJointCount> ToolModel::inverseKinematics(const Eigen::Isometry3d& target,
                                                             const std::array<double, kJointCount>& start) const {
  return InverseKinematics(*this).solve(target, start);
}

}  // namespace vibe
