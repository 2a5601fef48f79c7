#include "vibe_sim/procedure/marking_touch.hpp"

#include <algorithm>

#include "vibe_sim/solver/gas.hpp"
#include "vibe_sim/solver/lumen.hpp"

namespace vibe {

MarkingTouch::MarkingTouch(const Model& model) : model_(model), collision_(*model.tool) {}

bool MarkingTouch::mayReplaceSolver(const State& state) {
  const std::vector<Suture>& sutures = state.procedure.sutures;
  const bool draws = !sutures.empty() && sutures.back().stage == Suture::Stage::Cinching;
  return !draws && state.solver.homing == 0;
}

void MarkingTouch::follow(const std::vector<Eigen::Isometry3d>& link_poses, State& state, StepReport& report) {
  ProcedureState& procedure = state.procedure;
  if (procedure.base_x.empty()) {
    procedure.base_x = state.x;
    procedure.base_y = state.y;
    procedure.base_z = state.z;
  }
  const SurfaceView base{model_.organ.surface.triangles, procedure.base_x, procedure.base_y, procedure.base_z};
  const auto finder = [&](const auto& x, const auto& y, const auto& z, std::vector<Touch>& touches) {
    find(link_poses, state, x, y, z, touches);
  };
  const int held = touch_.follow(base, finder, state.x, state.y, state.z);
  report.contact_count = std::max(0, held - static_cast<int>(state.grip.size()));
  for (auto* v : {&state.vx, &state.vy, &state.vz, &state.ax, &state.ay, &state.az, &state.wx, &state.wy, &state.wz})
    std::fill(v->begin(), v->end(), 0.0);
  if (!model_.scene.gas) return;
  state.volume = lumenVolume(model_.organ.surface, state.x, state.y, state.z);
  state.pressure = gaugePressure(state.gas_amount, state.volume);
}

void MarkingTouch::handBack(State& state) {
  if (state.procedure.base_x.empty()) return;
  for (auto* base : {&state.procedure.base_x, &state.procedure.base_y, &state.procedure.base_z}) base->clear();
  state.solver.still = 0;  // it must not sleep in a shape that is not its own
}

void MarkingTouch::find(const std::vector<Eigen::Isometry3d>& link_poses, const State& state,
                        const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z,
                        std::vector<Touch>& touches) {
  for (const GripPoint& point : state.grip)
    touches.push_back({point.particle, link_poses[model_.grip_link] * point.local});
  const double radius = model_.particle_radius;
  collision_.findCandidates(link_poses, x.data(), y.data(), z.data(), model_.particle_count, radius);
  const auto& contacts = collision_.findContacts(link_poses, x.data(), y.data(), z.data(), radius);
  for (std::size_t first = 0, next; first < contacts.size(); first = next) {
    std::size_t deepest = first;  // of a particle in several shapes
    for (next = first + 1; next < contacts.size() && contacts[next].particle == contacts[first].particle; ++next)
      if (contacts[next].distance < contacts[deepest].distance) deepest = next;
    const Contact& contact = contacts[deepest];
    const int i = contact.particle;
    // the ends are open where the organ goes on
    if (model_.organ.end[i] != End::None || !(model_.inverse_mass[i] > 0)) continue;
    touches.push_back({i, Eigen::Vector3d(x[i], y[i], z[i]) + (radius - contact.distance) * contact.normal});
  }
}

}  // namespace vibe
