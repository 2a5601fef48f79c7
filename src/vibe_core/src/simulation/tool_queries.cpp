#include "vibe_core/simulation/tool_queries.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "arithmetic/turn.hpp"
#include "geometry/ray.hpp"
#include "tool/kinematics.hpp"
#include "tool/tool_motion.hpp"
namespace vibe {

namespace {

std::vector<Eigen::Isometry3d> linkPoses(const Model& model, const State& state) {
  std::vector<Eigen::Isometry3d> poses;
  model.tool->forwardKinematics(state.joints, state.tool_displacement, poses);
  return poses;
}

}  // namespace

Eigen::Isometry3d tipPose(const Model& model, const State& state) {
  return model.tool_base * linkPoses(model, state)[model.tip_link];
}

// A link that turns by w moves the end of an arm r by w x r, and w is half the sum of e x (w x e) over three axes e.
TipJacobian tipJacobian(const Model& model, const State& state) {
  const std::vector<Eigen::Isometry3d> poses = linkPoses(model, state);
  const ShaftBend bend = model.tool->shaftBend(state.joints, state.tool_displacement);
  const Eigen::Vector3d tip = poses[model.tip_link].translation();
  const auto at = [&](const Eigen::Vector3d& point) -> Eigen::Matrix<double, 3, kScopeJointCount> {
    return yieldJacobian(*model.tool, poses, bend, model.tip_link, point).leftCols<kScopeJointCount>();
  };
  const Eigen::Matrix3d to_world = model.tool_base.linear();
  const Eigen::Matrix<double, 3, kScopeJointCount> linear = at(tip);
  TipJacobian jacobian = TipJacobian::Zero();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(k);
    const Eigen::Matrix<double, 3, kScopeJointCount> arm = at(tip + axis) - linear;
    for (int j = 0; j < kScopeJointCount; ++j) jacobian.col(j).tail<3>() += 0.5 * axis.cross(arm.col(j));
  }
  jacobian.bottomRows<3>() = (to_world * jacobian.bottomRows<3>()).eval();
  jacobian.topRows<3>() = to_world * linear;
  return jacobian;
}

std::optional<WallSight> lookAhead(const Model& model, const State& state) {
  const Eigen::Isometry3d tip = tipPose(model, state);
  const Eigen::Vector3d view = tip.linear().col(0);
  const SurfaceView wall{model.organ.surface.triangles, state.x, state.y, state.z};
  const Ray ray(tip.translation() - model.particle_radius * view, view, model.particle_radius + kSightReach);
  const RayHit hit = firstHit(ray, wall);
  if (hit.triangle < 0) return {};
  const Eigen::Vector3d normal = areaVector(wall, wall.triangles[hit.triangle]).normalized();
  WallSight sight;
  sight.triangle = hit.triangle;
  sight.point = ray.at(hit.distance);
  sight.normal = normal.dot(view) > 0 ? Eigen::Vector3d(-normal) : normal;
  sight.distance = hit.distance - model.particle_radius;
  return sight;
}

namespace {

// Of the needle, as in make_scope_urdf.py of vibe_description; design choices.
constexpr double kHeldDepth = 1.2e-3;  // in the anchor exchange, deeper than the closed arm brings it [m]
constexpr double kHeldTurn = 0.4189;   // along the bore [rad]
constexpr double kGoneDepth = 0.018;   // within the rigid end of the endoscope [m]

struct NeedlePlace {
  double slide, turn, draw;
};

NeedlePlace placeOfNeedle(const Model& model, const State& state, double hook_turn) {
  const ProcedureState& procedure = state.procedure;
  if (procedure.needle_loaded && procedure.needle_on_arm) return {state.joints[NeedleDriver], hook_turn, 0};
  return {model.tool->limits()[NeedleDriver].upper, kHeldTurn, procedure.needle_loaded ? kHeldDepth : kGoneDepth};
}

// As the URDF has it for those who know the inputs only.
double mimicked(const ToolJoint& joint, double driver) {
  return joint.multiplier * driver + joint.offset;
}

bool probeIsOut(const Model& model, const State& state) {
  return model.scene.marking && state.procedure.pressed[ApcPedal] != 0;
}

}  // namespace

std::vector<DrawnJoint> drawnJoints(const Model& model, const State& state) {
  const ToolModel& tool = *model.tool;
  const double driver = state.joints[NeedleDriver];
  const std::optional<LinkageTurns> turns = needleLinkage(tool, driver);
  std::vector<DrawnJoint> drawn;
  const auto add = [&](const char* name, const auto& positionOf) {
    if (const ToolJoint* joint = findJoint(tool, name)) drawn.push_back({name, positionOf(*joint)});
  };
  const auto turnOfHook = [&](const ToolJoint& joint) { return turns ? turns->hook : mimicked(joint, driver); };
  const ToolJoint* turning = findJoint(tool, "needle_turn");
  const NeedlePlace needle = placeOfNeedle(model, state, turning != nullptr ? turnOfHook(*turning) : 0);
  add("needle_arm_hinge", [&](const ToolJoint& joint) { return turns ? turns->arm : mimicked(joint, driver); });
  add("needle_hook_turn", turnOfHook);
  add("needle_slide", [&](const ToolJoint&) { return needle.slide; });
  add("needle_turn", [&](const ToolJoint&) { return needle.turn; });
  add("needle_draw", [&](const ToolJoint&) { return needle.draw; });
  add("argon_probe", [&](const ToolJoint& joint) {
    return probeIsOut(model, state) ? model.scene.marking->apc.probe_length : joint.offset;
  });
  return drawn;
}

std::vector<Eigen::Isometry3d> drawnLinkPoses(const Model& model, const State& state) {
  const ToolModel& tool = *model.tool;
  const std::vector<Eigen::Isometry3d> simulated = linkPoses(model, state);
  const std::vector<DrawnJoint> drawn = drawnJoints(model, state);
  std::vector<Eigen::Isometry3d> poses(simulated.size(), model.tool_base * simulated[0]);
  for (const ToolJoint& joint : tool.joints()) {
    const auto is_this = [&](const DrawnJoint& one) { return one.name == joint.name; };
    const auto found = std::find_if(drawn.begin(), drawn.end(), is_this);
    Eigen::Isometry3d in_parent = joint.origin;
    if (found == drawn.end())
      in_parent = simulated[joint.parent_link].inverse() * simulated[joint.child_link];
    else if (joint.type == ToolJoint::Type::Prismatic)
      in_parent.translate(found->position * joint.axis);
    else
      in_parent.rotate(rotationAbout(joint.axis, found->position));
    poses[joint.child_link] = poses[joint.parent_link] * in_parent;
  }
  return poses;
}

}  // namespace vibe
