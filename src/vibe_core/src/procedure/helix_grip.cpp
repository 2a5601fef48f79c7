#include "vibe_core/procedure/helix_grip.hpp"

#include <algorithm>
#include <limits>

#include "procedure/procedure.hpp"
#include "vibe_core/events/event.hpp"

namespace vibe {

namespace {

Eigen::Vector3d position(const State& state, int particle) {
  return {state.x[particle], state.y[particle], state.z[particle]};
}

int nearestFreeParticle(const Model& model, const State& state, const Eigen::Vector3d& tip, double& distance) {
  int nearest = -1;
  distance = std::numeric_limits<double>::infinity();
  for (int i = 0; i < model.particle_count; ++i) {
    if (model.inverse_mass[i] == 0) continue;
    const double d = (position(state, i) - tip).norm();
    if (d < distance) {
      distance = d;
      nearest = i;
    }
  }
  return nearest;
}

void takeHold(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, State& state, EventLog log) {
  const HelixScene& helix = *model.scene.helix;
  const Eigen::Vector3d tip = link_poses[model.helix_link].translation();
  double distance = 0;
  const int target = nearestFreeParticle(model, state, tip, distance);
  if (target < 0 || distance > helix.reach) {
    log.emit(Event::Kind::GrabMissed, target, distance).limit = helix.reach;
    return;
  }
  const Eigen::Isometry3d to_grip = link_poses[model.grip_link].inverse();
  const Eigen::Vector3d centre = position(state, target);
  state.grip.push_back({target, to_grip * centre});
  for (int i = 0; i < model.particle_count; ++i) {
    if (i == target || model.inverse_mass[i] == 0) continue;
    const Eigen::Vector3d p = position(state, i);
    if ((p - centre).norm() <= helix.grip_radius) state.grip.push_back({i, to_grip * p});
  }
  const double held = static_cast<double>(state.grip.size());
  Event& event = log.emit(Event::Kind::Grab, target, held);
  event.region = model.organ.region[target];
  event.wall = model.organ.wall[target];
  state.procedure.grip_rotation = state.joints[HelixRotation];
  state.procedure.grip_turns = 0;
  if (model.scene.suture) noteSuturing(state, log);
}

void countTurns(const Model& model, State& state, EventLog log) {
  constexpr double kTurn = 6.28318530717958647692;  // [rad]
  const HelixScene& helix = *model.scene.helix;
  const double turns = (state.joints[HelixRotation] - state.procedure.grip_rotation) / kTurn;
  const double before = state.procedure.grip_turns;
  if (!(turns > before)) return;
  state.procedure.grip_turns = turns;
  if (before < helix.hold_turns && turns >= helix.hold_turns)
    log.emit(Event::Kind::HelixTurned, state.grip.front().particle, turns).limit = helix.hold_force;
}

}  // namespace

void updateGrip(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, bool pressed, State& state,
                EventLog log) {
  if (!model.scene.helix) return;
  const bool went_down = pressed && !state.helix_pressed;
  const bool went_up = !pressed && state.helix_pressed;
  state.helix_pressed = pressed;
  if (went_down && state.grip.empty()) takeHold(model, link_poses, state, log);
  if (went_up && !state.grip.empty()) {
    log.emit(Event::Kind::Release, state.grip.front().particle, state.grip_force);
    state.grip.clear();
  }
}

double holdingForce(const HelixScene& helix, double turns) {
  if (turns >= helix.hold_turns) return helix.hold_force;
  return helix.initial_hold_force +
         (helix.hold_force - helix.initial_hold_force) * std::max(turns, 0.0) / helix.hold_turns;
}

void releaseOverloadedGrip(const Model& model, State& state, EventLog log) {
  if (!model.scene.helix || state.grip.empty()) return;
  countTurns(model, state, log);
  const double hold = holdingForce(*model.scene.helix, state.procedure.grip_turns);
  if (state.grip_force <= hold) return;
  Event& event = log.emit(Event::Kind::Slip, state.grip.front().particle, state.grip_force);
  event.limit = hold;
  event.amount = state.procedure.grip_turns;
  state.grip.clear();
}

}  // namespace vibe
