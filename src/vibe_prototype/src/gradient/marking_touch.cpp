#include "gradient/marking_touch.hpp"

#include <algorithm>

#include "geometry/surface_operators.hpp"
#include "tool_contact/tool_collision.hpp"
#include "vibe_core/constraints/gas.hpp"

namespace vibe::prototype {

namespace {

constexpr double kFarthest = 0.8e-3;  // move of a particle in a step of the handover; design choice [m]

}  // namespace

MarkingTouch::MarkingTouch(const Model& model) : model_(model), collision_(*model.tool) {}

bool MarkingTouch::mayReplaceSolver(const State& state) {
  const std::vector<Suture>& sutures = state.procedure.sutures;
  const bool draws = !sutures.empty() && sutures.back().stage == Suture::Stage::Cinching;
  return !draws && !state.pull.holds() && state.solver.recovery_steps == 0;
}

void MarkingTouch::advance(const ToolMotion& motion, bool pedal, const std::function<void()>& solve, State& state,
                           StepReport& report) {
  if (pedal && mayReplaceSolver(state)) return update(motion, state, report);
  handBack(motion, solve, state);
}

void MarkingTouch::update(const ToolMotion& motion, State& state, StepReport& report) {
  const ProcedureState& procedure = state.procedure;
  if (procedure.base_x.empty()) storeBase(state);
  motion.linkPoses(1, poses_);
  const SurfaceView base{model_.organ.surface.triangles, procedure.base_x, procedure.base_y, procedure.base_z};
  const auto finder = [&](const auto& x, const auto& y, const auto& z, std::vector<Touch>& touches) {
    find(state, x, y, z, touches);
  };
  const int held = touch_.update(base, finder, state.x, state.y, state.z);
  const double whole = wholeWeight(state.grip);
  const auto gripped = std::count_if(state.grip.begin(), state.grip.end(),
                                     [whole](const GripPoint& point) { return point.weight >= whole; });
  report.contact_count = std::max(0, held - static_cast<int>(gripped));
  for (auto* v : {&state.vx, &state.vy, &state.vz, &state.ax, &state.ay, &state.az, &state.wx, &state.wy, &state.wz})
    std::fill(v->begin(), v->end(), 0.0);
  updateGas(state);
}

void MarkingTouch::handBack(const ToolMotion& motion, const std::function<void()>& solver_step, State& state) {
  if (state.procedure.base_x.empty()) return solver_step();
  // from now on the base is the shape before the step, so that pressing the pedal again starts from the present wall
  storeBase(state);
  state.solver.rest_steps = 0;  // the solver must not stop in a shape that is no equilibrium
  motion.linkPoses(0, old_poses_);
  motion.linkPoses(1, poses_);
  solver_step();
  limitStep(kFarthest + motion.travel(old_poses_, poses_), state);
}

// Shortens the last step, or ends the handover if the step was short enough.
void MarkingTouch::limitStep(double farthest, State& state) const {
  ProcedureState& procedure = state.procedure;
  double largest = 0;
  for (int i = 0; i < model_.particle_count; ++i)
    largest = std::max(largest, Eigen::Vector3d(state.x[i] - procedure.base_x[i], state.y[i] - procedure.base_y[i],
                                                state.z[i] - procedure.base_z[i])
                                    .norm());
  if (!(largest > farthest) || state.solver.recovery_steps > 0) {
    for (auto* base : {&procedure.base_x, &procedure.base_y, &procedure.base_z}) base->clear();
    return;
  }
  const double part = farthest / largest;
  for (int i = 0; i < model_.particle_count; ++i) {
    state.x[i] = procedure.base_x[i] + part * (state.x[i] - procedure.base_x[i]);
    state.y[i] = procedure.base_y[i] + part * (state.y[i] - procedure.base_y[i]);
    state.z[i] = procedure.base_z[i] + part * (state.z[i] - procedure.base_z[i]);
  }
  for (auto* v : {&state.vx, &state.vy, &state.vz, &state.ax, &state.ay, &state.az})
    std::fill(v->begin(), v->end(), 0.0);
  storeBase(state);
  updateGas(state);
}

void MarkingTouch::storeBase(State& state) const {
  state.procedure.base_x = state.x;
  state.procedure.base_y = state.y;
  state.procedure.base_z = state.z;
}

void MarkingTouch::updateGas(State& state) const {
  if (!model_.scene.gas) return;
  state.volume = lumenVolume(model_.organ.surface, state.x, state.y, state.z);
  state.pressure = gaugePressure(state.gas_amount, state.volume);
}

void MarkingTouch::find(const State& state, const std::vector<double>& x, const std::vector<double>& y,
                        const std::vector<double>& z, std::vector<Touch>& touches) {
  const double whole = wholeWeight(state.grip);
  for (const GripPoint& point : state.grip)
    if (point.weight >= whole) touches.push_back({point.particle, poses_[model_.grip_link] * point.local});
  const double radius = model_.particle_radius;
  collision_.findCandidates(poses_, x.data(), y.data(), z.data(), model_.particle_count, radius);
  const auto& contacts = collision_.findContacts(poses_, x.data(), y.data(), z.data(), radius);
  forEachDeepest(contacts, [&](const Contact& contact) {
    const int i = contact.particle;
    // the ends are open: the organ continues there
    if (model_.organ.end[i] != End::None || !(model_.inverse_mass[i] > 0)) return;
    touches.push_back({i, Eigen::Vector3d(x[i], y[i], z[i]) + (radius - contact.distance) * contact.normal});
  });
}

}  // namespace vibe::prototype
