#include "vibe_core/trainee/observation.hpp"

#include <algorithm>
#include <cmath>

#include "vibe_core/procedure/stitch.hpp"

namespace vibe {

namespace {

constexpr double kImageRate = 60;  // of the wall, in simulated time: a video screen [Hz]

void observeWall(const State& state, Observation& seen) {
  seen.wall.reserve(state.x.size());
  for (std::size_t i = 0; i < state.x.size(); ++i)
    seen.wall.emplace_back(static_cast<float>(state.x[i]), static_cast<float>(state.y[i]),
                           static_cast<float>(state.z[i]));
}

void observeTool(const Model& model, const State& state, Observation& seen) {
  seen.joints = state.joints;
  seen.force = state.tool_force;
  std::vector<Eigen::Isometry3d> poses;
  model.tool->forwardKinematics(state.joints, state.tool_displacement, poses);
  const Eigen::Isometry3d tip = model.tool_base * poses[model.tip_link];
  seen.tip = tip.translation();
  seen.tip_turn = Eigen::Quaterniond(tip.linear());
  seen.helix = (model.tool_base * poses[model.helix_link]).translation();
}

void observeProcedure(const ProcedureState& procedure, Observation& seen) {
  seen.arm_closed = procedure.arm_closed;
  seen.needle_on_arm = procedure.needle_on_arm;
  seen.needle_loaded = procedure.needle_loaded;
  seen.sets = static_cast<int>(procedure.sutures.size());
  if (procedure.sutures.empty()) return;
  const Suture& last = procedure.sutures.back();
  seen.bites = static_cast<int>(last.bites.size());
  seen.stage = last.stage;
  seen.tension = last.tension.empty() ? 0 : cinchTension(last);
}

void observeEvents(const std::vector<Event>& events, Observation& seen) {
  for (const Event& event : events) {
    if (event.kind == Event::Kind::Warning) continue;
    Event& perceived = seen.events.emplace_back();
    perceived.kind = event.kind;
    perceived.time = seen.time;
    perceived.particle = event.particle;
    perceived.value = event.value;
  }
}

}  // namespace

int imageInterval(double step_period) {
  return std::max(1, static_cast<int>(std::lround(1 / (kImageRate * step_period))));
}

bool hasImage(const Simulation& simulation) {
  return simulation.state().step % imageInterval(simulation.stepPeriod()) == 0;
}

Observation observe(const Simulation& simulation, bool wall) {
  const State& state = simulation.state();
  Observation seen;
  seen.step = state.step;
  seen.time = state.time;
  if (wall && hasImage(simulation)) observeWall(state, seen);
  if (simulation.model().tool) observeTool(simulation.model(), state, seen);
  seen.pressure = state.pressure;
  seen.pressure_reached = state.pressure_reached;
  seen.grips = !state.grip.empty();
  observeProcedure(state.procedure, seen);
  observeEvents(simulation.events(), seen);
  return seen;
}

}  // namespace vibe
