#include "tool/hand_model.hpp"

#include <algorithm>
#include <cmath>

#include "vibe_core/solver/step_policy.hpp"

namespace vibe {

HandModel::Joints HandModel::follow(const Joints& command, const State& state, double dt) const {
  const Joints& start = state.joints;
  Joints end = withinLimits(start, command, dt);
  // springs between hand and tool say by themselves what the hand would have to bear
  end = springs_ != nullptr ? springs_->handMotion(start, end, state.tool_displacement, dt)
                            : withinEffort(start, end, state.hand_effort);
  end = slowedByForce(start, end, state.hand_effort, state.tool_force.norm());
  return heldBack(start, end, state.stall);
}

HandModel::Joints HandModel::withinLimits(const Joints& start, const Joints& command, double dt) const {
  Joints result = start;
  for (int i = 0; i < kJointCount; ++i) {
    if (!std::isfinite(command[i])) continue;
    const JointLimits& limit = tool_.limits()[i];
    const double target = std::clamp(command[i], limit.lower, limit.upper);
    const double furthest = limit.velocity * dt;
    result[i] = start[i] + std::clamp(target - start[i], -furthest, furthest);
  }
  return result;
}

HandModel::Joints HandModel::withinEffort(const Joints& start, const Joints& end,
                                          const std::array<double, kScopeJointCount>& effort) const {
  Joints result = end;
  for (int j = 0; j < kScopeJointCount; ++j) {
    const bool over = std::abs(effort[j]) > tool_.limits()[j].effort;
    if (over && (end[j] - start[j]) * effort[j] > 0) result[j] = start[j];
  }
  return result;
}

HandModel::Joints HandModel::slowedByForce(const Joints& start, const Joints& end,
                                           const std::array<double, kScopeJointCount>& effort, double force) {
  const double slows = stepPolicy().hand_slows_force, stops = stepPolicy().hand_stops_force;
  const double part = std::clamp((stops - force) / (stops - slows), 0.0, 1.0);
  Joints result = end;
  for (int j = 0; j < kScopeJointCount; ++j)
    if ((end[j] - start[j]) * effort[j] > 0) result[j] = start[j] + part * (end[j] - start[j]);
  return result;
}

HandModel::Joints HandModel::heldBack(const Joints& start, const Joints& end,
                                      const std::array<int, kJointCount>& stall) {
  Joints result = end;
  for (int j = 0; j < kJointCount; ++j)
    if ((end[j] - start[j]) * stall[j] > 0) result[j] = start[j];
  return result;
}

void HandModel::countStall(const std::array<int, kJointCount>& stopped, std::array<int, kJointCount>& stall) {
  for (int j = 0; j < kJointCount; ++j) {
    stall[j] -= stall[j] > 0 ? 1 : stall[j] < 0 ? -1 : 0;
    if (stopped[j] != 0) stall[j] = stopped[j] * stepPolicy().hand_stall_steps;
  }
}

}  // namespace vibe
