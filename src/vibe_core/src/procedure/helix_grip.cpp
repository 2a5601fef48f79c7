#include "vibe_core/procedure/helix_grip.hpp"

#include <algorithm>
#include <limits>

#include "procedure/procedure.hpp"
#include "vibe_core/events/event.hpp"
#include "vibe_core/geometry/surface_disc.hpp"
#include "vibe_core/geometry/triangle_tree.hpp"

namespace vibe {

namespace {

Eigen::Vector3d position(const State& state, int particle) {
  return {state.x[particle], state.y[particle], state.z[particle]};
}

/// The point of the wall nearest to the tip of the helix.
struct Foot {
  int triangle = -1;                                          // -1: no wall that could be held
  Eigen::Vector3d point;                                      // [m]
  double distance = std::numeric_limits<double>::infinity();  // [m]
  int particle = -1;                                          // of the triangle, the free one nearest to the tip
};

Foot footOf(const Model& model, const State& state, const Eigen::Vector3d& tip) {
  Foot foot;
  const auto& triangles = model.organ.surface.triangles;
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    const auto& v = triangles[t];
    if (std::all_of(v.begin(), v.end(), [&](int i) { return model.inverse_mass[i] == 0; })) continue;
    const Eigen::Vector3d point =
        closestPointOnTriangle(tip, position(state, v[0]), position(state, v[1]), position(state, v[2]));
    const double distance = (point - tip).norm();
    if (distance < foot.distance) foot.triangle = t, foot.point = point, foot.distance = distance;
  }
  if (foot.triangle < 0) return foot;
  double nearest = std::numeric_limits<double>::infinity();
  for (const int i : triangles[foot.triangle]) {
    const double distance = (position(state, i) - tip).norm();
    if (model.inverse_mass[i] != 0 && distance < nearest) nearest = distance, foot.particle = i;
  }
  return foot;
}

/// The disc around a point of the wall, without what is fixed; the particle that is named first.
std::vector<GripPoint> discAround(const Model& model, const Foot& foot, const Eigen::Isometry3d& to_grip,
                                  const State& state) {
  const SurfaceView wall{model.organ.surface.triangles, state.x, state.y, state.z};
  const DiscWeights disc =
      discWeights(model.organ.surface, wall, foot.triangle, foot.point, model.scene.helix->grip_radius);
  std::vector<GripPoint> grip;
  double sum = 0;
  for (std::size_t k = 0; k < disc.vertex.size(); ++k) {
    const int i = disc.vertex[k];
    if (model.inverse_mass[i] == 0) continue;
    grip.push_back({i, to_grip * position(state, i), disc.weight[k]});
    sum += disc.weight[k];
  }
  for (GripPoint& point : grip) point.weight /= sum;
  std::stable_partition(grip.begin(), grip.end(), [&](const GripPoint& p) { return p.particle == foot.particle; });
  return grip;
}

void takeHold(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, State& state, EventLog log) {
  const HelixScene& helix = *model.scene.helix;
  const Eigen::Vector3d tip = link_poses[model.helix_link].translation();
  const Foot foot = footOf(model, state, tip);
  if (foot.triangle < 0 || foot.distance > helix.reach) {
    log.emit(Event::Kind::GrabMissed, foot.particle, foot.distance).limit = helix.reach;
    return;
  }
  state.grip = discAround(model, foot, link_poses[model.grip_link].inverse(), state);
  const double held = static_cast<double>(state.grip.size());
  Event& event = log.emit(Event::Kind::Grab, foot.particle, held);
  event.region = model.organ.region[foot.particle];
  event.wall = model.organ.wall[foot.particle];
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
