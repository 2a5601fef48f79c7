#include "vibe_core/procedure/helix_grip.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "procedure/phase.hpp"

namespace vibe {

namespace {

std::string millimetres(double metres) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f mm", metres * 1e3);
  return text;
}

std::string newtons(double force) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f N", force);
  return text;
}

std::string inTurns(double turns) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f turns", turns);
  return text;
}

Eigen::Vector3d position(const State& state, int particle) {
  return {state.x[particle], state.y[particle], state.z[particle]};
}

Event makeEvent(Event::Kind kind, double time, int particle, double value, std::string text) {
  Event event;
  event.kind = kind;
  event.time = time;
  event.particle = particle;
  event.value = value;
  event.text = std::move(text);
  return event;
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

void takeHold(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, State& state,
              std::vector<Event>& events) {
  const HelixScene& helix = *model.scene.helix;
  const Eigen::Vector3d tip = link_poses[model.helix_link].translation();
  double distance = 0;
  const int target = nearestFreeParticle(model, state, tip, distance);
  if (target < 0 || distance > helix.reach) {
    events.push_back(makeEvent(Event::Kind::GrabMissed, state.time, target, distance,
                               "The helix found no tissue: the nearest is " + millimetres(distance) +
                                   " from its tip and it reaches " + millimetres(helix.reach) + "."));
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
  events.push_back(makeEvent(Event::Kind::Grab, state.time, target, held,
                             "The helix holds the " + std::string(toString(model.organ.region[target])) + ", " +
                                 toString(model.organ.wall[target]) + " wall."));
  state.procedure.grip_rotation = state.joints[HelixRotation];
  state.procedure.grip_turns = 0;
  if (model.scene.suture) noteSuturing(state, events);
}

void countTurns(const Model& model, State& state, std::vector<Event>& events) {
  constexpr double kTurn = 6.28318530717958647692;  // [rad]
  const HelixScene& helix = *model.scene.helix;
  const double turns = (state.joints[HelixRotation] - state.procedure.grip_rotation) / kTurn;
  const double before = state.procedure.grip_turns;
  if (!(turns > before)) return;
  state.procedure.grip_turns = turns;
  if (before < helix.hold_turns && turns >= helix.hold_turns)
    events.push_back(makeEvent(Event::Kind::HelixTurned, state.time, state.grip.front().particle, turns,
                               "The helix is " + inTurns(turns) + " in and holds " + newtons(helix.hold_force) + "."));
}

}  // namespace

void updateGrip(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, bool pressed, State& state,
                std::vector<Event>& events) {
  if (!model.scene.helix) return;
  const bool went_down = pressed && !state.helix_pressed;
  const bool went_up = !pressed && state.helix_pressed;
  state.helix_pressed = pressed;
  if (went_down && state.grip.empty()) takeHold(model, link_poses, state, events);
  if (went_up && !state.grip.empty()) {
    events.push_back(makeEvent(Event::Kind::Release, state.time, state.grip.front().particle, state.grip_force,
                               "The helix let go of the tissue at " + newtons(state.grip_force) + "."));
    state.grip.clear();
  }
}

double holdingForce(const HelixScene& helix, double turns) {
  if (turns >= helix.hold_turns) return helix.hold_force;
  return helix.initial_hold_force +
         (helix.hold_force - helix.initial_hold_force) * std::max(turns, 0.0) / helix.hold_turns;
}

void releaseOverloadedGrip(const Model& model, State& state, std::vector<Event>& events) {
  if (!model.scene.helix || state.grip.empty()) return;
  countTurns(model, state, events);
  const double hold = holdingForce(*model.scene.helix, state.procedure.grip_turns);
  if (state.grip_force <= hold) return;
  events.push_back(makeEvent(Event::Kind::Slip, state.time, state.grip.front().particle, state.grip_force,
                             "The helix tore off at " + newtons(state.grip_force) + ", after " +
                                 inTurns(state.procedure.grip_turns) + " it holds " + newtons(hold) + "."));
  state.grip.clear();
}

}  // namespace vibe
