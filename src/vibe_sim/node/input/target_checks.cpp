#include "input/target_checks.hpp"

#include <vector>

#include "vibe_core/files/number_text.hpp"
#include "vibe_core/input/joint_unit.hpp"

namespace vibe::sim {
namespace {

constexpr double kFarthest = 3;       // times what there is
constexpr double kBeyondLimit = 0.1;  // of the range of a joint

/// Distance of the tip from the root link with the scope straight and all the way in [m].
double reachOf(const Model& model) {
  JointArray joints{};
  joints[Insertion] = model.tool->limits()[Insertion].upper;
  std::vector<Eigen::Isometry3d> poses;
  model.tool->forwardKinematics(joints, poses);
  return poses[static_cast<std::size_t>(model.tip_link)].translation().norm();
}

std::string refusalOfPlace(const InputSample& sample, const Model& model) {
  const Eigen::Vector3d place = sample.target == ScopeTarget::TipInWorld
                                    ? Eigen::Vector3d(model.tool_base.inverse() * sample.tip_pose.translation())
                                    : sample.tip_pose.translation();
  const double reach = reachOf(model);
  if (place.norm() <= kFarthest * reach) return "";
  return formatted(
      "%s asks for a place %.3g m from the base of the scope, which reaches %.2g m, and is ignored; the place may be "
      "in millimetres or in another frame: give metres in world or scope_base.",
      topicOf(sample).c_str(), place.norm(), reach);
}

std::string refusalOfVelocity(const InputSample& sample, const Model& model) {
  const double linear = sample.tip_twist.head<3>().norm(), most = kFarthest * reachOf(model);
  const double angular = sample.tip_twist.tail<3>().norm(), turn = kFarthest * model.tool->limits()[Rotation].velocity;
  if (linear > most)
    return formatted("%s asks for %.3g m/s, more than %.2g m/s, and is ignored; it may be in millimetres: give m/s.",
                     topicOf(sample).c_str(), linear, most);
  if (angular > turn)
    return formatted("%s asks for %.3g rad/s, more than %.2g rad/s, and is ignored; it may be in degrees: give rad/s.",
                     topicOf(sample).c_str(), angular, turn);
  return "";
}

std::string refusalOfPull(const InputSample& sample, const Model& model) {
  if (sample.pull_particle < 0 || sample.pull_particle >= model.particle_count) return "";
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : model.organ.surface.vertices) box.extend(vertex);
  const double size = box.diagonal().norm();
  const double far =
      (sample.pull_target - model.organ.surface.vertices[static_cast<std::size_t>(sample.pull_particle)]).norm();
  if (far <= kFarthest * size) return "";
  return formatted(
      "tissue/pull asks for a target %.3g m from its particle, in an organ of %.2g m, and is ignored; the target may "
      "be in millimetres: give metres in world.",
      far, size);
}

}  // namespace

std::string refusalOf(const InputSample& sample, const Model& model) {
  if (sample.channel == InputChannel::Pull) return refusalOfPull(sample, model);
  if (!model.tool || sample.target == ScopeTarget::Joints) return "";
  const bool pose = sample.target == ScopeTarget::TipInWorld || sample.target == ScopeTarget::TipInBase;
  return pose ? refusalOfPlace(sample, model) : refusalOfVelocity(sample, model);
}

std::string beyondLimits(const InputSample& sample, const Model& model) {
  const bool scope = sample.channel == InputChannel::Scope;
  if (!model.tool || sample.target != ScopeTarget::Joints || (!scope && sample.channel != InputChannel::SuturingDevice))
    return "";
  const int first = scope ? 0 : kScopeJointCount, end = scope ? kScopeJointCount : kJointCount;
  for (int j = first; j < end; ++j) {
    const auto i = static_cast<std::size_t>(j);
    const JointLimits& limit = model.tool->limits()[i];
    const double slack = kBeyondLimit * (limit.upper - limit.lower), asked = sample.joints[i];
    if (asked >= limit.lower - slack && asked <= limit.upper + slack) continue;
    return formatted(
        "%s asks for %s at %.3g %s, and it goes from %.3g to %.3g: it goes to its limit; the value may be in %s.",
        topicOf(sample).c_str(), kJointNames[i], asked, jointUnit(j), limit.lower, limit.upper,
        isPrismatic(j) ? "millimetres: give metres" : "degrees: give radians");
  }
  return "";
}

}  // namespace vibe::sim
