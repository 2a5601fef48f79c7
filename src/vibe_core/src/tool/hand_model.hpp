#pragma once

#include <array>

#include "vibe_core/state/state.hpp"
#include "vibe_core/tool/scope_springs.hpp"
#include "vibe_core/tool/tool_model.hpp"

namespace vibe {

/// The hand that moves the tool: how far it follows a command within a step. It keeps within the limits of the joints,
/// its force is limited, it slows down as it feels the force on the tip, and it does not push a joint on that tissue
/// has stopped a moment ago. What it feels is that of the last step, in the state.
class HandModel {
 public:
  using Joints = std::array<double, kJointCount>;  ///< positions of the inputs [m], [rad]

  /// @param springs  between the hand and a tool that yields; null: a rigid tool. Both must outlive this
  HandModel(const ToolModel& tool, const ScopeSprings* springs) : tool_(tool), springs_(springs) {}

  /// Where the joints are after a step of the duration dt [s]. Entries of the command that are not finite keep their
  /// position.
  Joints follow(const Joints& command, const State& state, double dt) const;
  /// State::stall after a step.
  /// @param stopped  sign of the motion of each joint that tissue has stopped in the step, 0: it has not
  static void countStall(const std::array<int, kJointCount>& stopped, std::array<int, kJointCount>& stall);

  /// One after the other, what follow() does. On the way towards the command, within the limits of position and speed.
  Joints withinLimits(const Joints& start, const Joints& command, double dt) const;
  /// A hand whose force is limited does not move a joint of the scope on against an effort beyond JointLimits::effort.
  Joints withinEffort(const Joints& start, const Joints& end, const std::array<double, kScopeJointCount>& effort) const;
  /// The nearer the force on the tip is to the largest that a hand applies, the less it moves a joint on against it.
  /// @param force  on the tool [N]
  static Joints slowedByForce(const Joints& start, const Joints& end,
                              const std::array<double, kScopeJointCount>& effort, double force);
  /// @param stall  steps for which a joint is not pushed on, with the sign of the direction; 0: it is not stopped
  static Joints heldBack(const Joints& start, const Joints& end, const std::array<int, kJointCount>& stall);

 private:
  const ToolModel& tool_;
  const ScopeSprings* springs_;
};

}  // namespace vibe
