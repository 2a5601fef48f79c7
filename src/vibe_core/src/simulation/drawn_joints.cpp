#include "vibe_core/simulation/drawn_joints.hpp"

#include <optional>

#include "contact/needle_linkage.hpp"

namespace vibe {
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

}  // namespace vibe
