#include "vibe_core/simulation/simulator.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "procedure/marking.hpp"
#include "procedure/procedure.hpp"
#include "procedure/suturing.hpp"
#include "tool/hand_model.hpp"
#include "tool/tool_motion.hpp"
#include "vibe_core/constraints/gas.hpp"
#include "vibe_core/constraints/pull_patch.hpp"
#include "vibe_core/events/event.hpp"
#include "vibe_core/geometry/surface_mesh.hpp"
#include "vibe_core/procedure/helix_grip.hpp"

namespace vibe {

Workspace::Workspace(const Model& model, int threads)
    : pool_(threads),
      solver_workspace_(model.solver->makeWorkspace(model)),
      marking_(model.scene.marking && model.tool ? std::make_unique<MarkingScratch>(model) : nullptr) {}

Workspace::~Workspace() = default;

void Workspace::measureStages() {
  stages_ = std::make_unique<StageClock>();
  solver_workspace_->stages = stages_.get();
}

namespace {

// Steps in which nothing of the tool moves on before that is an event. Design choice: shorter stops are the rule where
// a wall has to give way first.
constexpr int kBlockedSteps = 6;

// The tip is looked for this often [s], from this insertion on [m]. Design choice: a loop over all triangles must not
// be felt; and the end of the oesophagus follows the breath by less.
constexpr double kLumenPeriod = 0.25, kEntered = 0.04;

// A wall that is drawn over the face does not reach so far behind it [m].
constexpr double kTipLength = 0.015;

// Forces are reported in the tip's frame at the end of the step.
void storeForces(const Model& model, const StepReport& report, const std::vector<Eigen::Isometry3d>& poses,
                 State& state) {
  const Eigen::Matrix3d to_tip = poses[model.tip_link].linear().transpose();
  state.tool_force = to_tip * report.tool_force;
  state.tool_torque = to_tip * report.tool_torque;
  state.tool_load = report.tool_load;
  state.grip_force = report.grip_force.norm();
  state.hand_effort = report.hand_effort;
  state.contact_count = report.contact_count;
}

void reportContact(int contact_count, double dt, State& state, EventLog log) {
  const bool touching = contact_count > 0;
  if (touching && !state.in_contact) log.emit(Event::Kind::ContactBegin, -1, contact_count);
  state.untouched_time = touching || !state.in_contact ? 0 : state.untouched_time + dt;
  const bool ended = state.in_contact && state.untouched_time >= kContactGap;
  if (ended) log.emit(Event::Kind::ContactEnd);
  state.in_contact = touching || (state.in_contact && !ended);
}

// @param particle  nearest to what has stopped the tool in this step, -1: nothing has
void reportBlocked(const Model& model, int particle, State& state, EventLog log) {
  state.blocked_steps = particle < 0 ? 0 : state.blocked_steps + 1;
  if (state.blocked_steps != kBlockedSteps) return;
  Event& event = log.emit(Event::Kind::Blocked, particle, state.tool_force.norm());
  event.region = model.organ.region[particle];
  event.wall = model.organ.wall[particle];
}

void reportPressure(const GasScene& gas, bool insufflator_on, State& state, EventLog log) {
  const bool reached = insufflator_on && isAtSetPoint(state.pressure, gas.regulated_pressure, state.pressure_reached);
  if (reached && !state.pressure_reached) log.emit(Event::Kind::PressureReached, -1, state.pressure);
  state.pressure_reached = reached;
}

std::int64_t lumenSteps(double dt) {
  return std::max<std::int64_t>(1, std::lround(kLumenPeriod / dt));
}

// The ends of the organ are open, so that a tip may go on outside of it, where no wall meets it.
// @param tip  pose in world
void reportLumen(const Model& model, const Eigen::Isometry3d& tip, State& state, EventLog log) {
  const double insertion = state.joints[Insertion] + state.tool_displacement[Insertion];
  const SurfaceView wall{model.organ.surface.triangles, state.x, state.y, state.z};
  const bool left = insertion >= kEntered && !isWithin(wall, tip.translation()) &&
                    !isWithin(wall, tip * Eigen::Vector3d(-kTipLength, 0, 0));
  if (left && !state.lumen.left) log.emit(Event::Kind::LeftLumen, -1, insertion);
  state.lumen.left = left;
}

// NaN or infinity anywhere makes the sum NaN. Four sums, since one would wait for every addition.
bool isFinite(const State& state) {
  double sum[4] = {state.gas_amount, 0, 0, 0};
  for (const auto* v : {&state.x, &state.y, &state.z, &state.vx, &state.vy, &state.vz, &state.ax, &state.ay, &state.az,
                        &state.qw, &state.qx, &state.qy, &state.qz}) {
    const std::size_t size = v->size(), whole = size / 4 * 4;
    const double* const value = v->data();
    for (std::size_t i = 0; i < whole; i += 4)
      for (std::size_t k = 0; k < 4; ++k) sum[k] += 0 * value[i + k];
    for (std::size_t i = whole; i < size; ++i) sum[0] += 0 * value[i];
  }
  return std::isfinite(sum[0] + sum[1] + sum[2] + sum[3]);
}

// A state with numbers that are not finite cannot be continued: the tissue starts again from rest, with an event.
void recover(const Model& model, State& state, EventLog log) {
  const State fresh = initialState(model, state.seed);
  state.x = fresh.x, state.y = fresh.y, state.z = fresh.z;
  state.vx = fresh.vx, state.vy = fresh.vy, state.vz = fresh.vz;
  state.ax = fresh.ax, state.ay = fresh.ay, state.az = fresh.az;
  state.solver = fresh.solver;
  state.impedance = fresh.impedance;
  state.qw = fresh.qw, state.qx = fresh.qx, state.qy = fresh.qy, state.qz = fresh.qz;
  state.wx = fresh.wx, state.wy = fresh.wy, state.wz = fresh.wz;
  state.gas_amount = fresh.gas_amount;
  state.pressure = fresh.pressure;
  state.volume = fresh.volume;
  state.energy = fresh.energy;
  state.motion.muscle_work = 0;
  state.relaxation = fresh.relaxation;
  state.grip.clear();
  state.pull = PullSpring();
  slackenThreads(model, state);
  coolDown(state);
  state.tool_displacement = fresh.tool_displacement;
  state.stall = fresh.stall;
  state.blocked_steps = 0;
  state.hand_effort = fresh.hand_effort;
  state.tool_force.setZero();
  state.tool_torque.setZero();
  state.tool_load = fresh.tool_load;
  state.grip_force = 0;
  log.emit(Event::Kind::Recovery).detail = EventDetail::NotFinite;
}

// Where a tool goes on which nothing acts.
ToolDisplacement relaxed(const Model& model, const State& state, double dt) {
  ToolDisplacement end = state.tool_displacement;
  const YieldVector moved = model.scope_springs->during(state.joints, end, end, dt).yield().free;
  for (int d = 0; d < kYieldDofs; ++d) end[d] += moved[d];
  return end;
}

void moveTissue(const Model& model, const ToolMotion* motion, bool pedal, bool insufflator_on, State& state,
                Workspace& workspace, StepReport& report) {
  const auto solve = [&] {
    model.solver->advance(model, motion, insufflator_on, state, workspace.solverWorkspace(), workspace.threadPool(),
                          report);
  };
  MarkingDeformation* own = motion && workspace.marking() ? workspace.marking()->deformation.get() : nullptr;
  if (!own) return solve();
  own->advance(*motion, pedal, solve, state, report);
}

}  // namespace

bool insufflatorIsOn(const Model& model, const StepInput& input) {
  return model.scene.gas && (model.scene.gas->insufflator_on || input.buttons[Insufflate] != 0);
}

void step(const Model& model, State& state, const StepInput& input, Workspace& workspace, std::vector<Event>& events) {
  const EventLog log(state, events);
  const double dt = model.scene.step_period;
  StageClock* const stages = workspace.solverWorkspace().stages;
  if (stages != nullptr) stages->start();
  const bool insufflator_on = insufflatorIsOn(model, input);
  const bool pedal = input.buttons[ApcPedal] != 0;
  BeamStep beam{pedal, pedal && state.procedure.pressed[ApcPedal] == 0, 0};
  const double gas_before = state.gas_amount;
  std::optional<ToolMotion> motion;
  ToolPoses& poses = workspace.solverWorkspace().tool;
  if (model.tool) {
    const ScopeSprings* const springs = model.scope_springs ? &*model.scope_springs : nullptr;
    const auto end = HandModel(*model.tool, springs).follow(input.joints, state, dt);
    motion.emplace(*model.tool, model.tool_base, state.joints, end, state.tool_displacement);
    std::swap(poses.start, poses.end);  // it starts where the last step ended
    motion->linkPoses(0, poses.start);
    poses.needle_leads = state.procedure.needle_loaded && state.procedure.needle_on_arm;
    updateGrip(model, poses.start, input.buttons[HelixGrab] != 0, state, log);
    commandProcedure(model, poses.start, input, state, log);
    state.joints = end;
  } else {
    commandProcedure(model, {}, input, state, log);  // says which part of the scene is missing
  }
  movePullSpring(model, input, state);
  const bool held = input.breath == Breath::Held && breathingOf(model.scene);
  state.motion.held = held;
  StepReport& report = workspace.report();
  report.clear();
  if (model.scope_springs) report.tool_displacement = relaxed(model, state, dt);
  moveTissue(model, motion ? &*motion : nullptr, pedal, insufflator_on, state, workspace, report);
  beam.insufflation = std::max(0.0, (state.gas_amount - gas_before) / (kAmbientPressure * dt));
  ++state.step;
  state.time = static_cast<double>(state.step) * dt;
  if (held) state.motion.held_time += dt;
  if (model.tool) {
    state.tool_displacement = report.tool_displacement;
    HandModel::countStall(report.stopped, state.stall);
    ToolMotion(*model.tool, model.tool_base, state.joints, state.joints, state.tool_displacement)
        .linkPoses(1, poses.end);
    storeForces(model, report, poses.end, state);
    reportContact(report.contact_count, dt, state, log);
    reportBlocked(model, report.blocking_particle, state, log);
    releaseOverloadedGrip(model, state, log);
    if (workspace.marking()) updateMarking(model, poses.end, beam, state, *workspace.marking(), log);
    updateProcedure(model, state, log);
  }
  if (model.scene.gas) reportPressure(*model.scene.gas, insufflator_on, state, log);
  if (report.speed_limited > 0)
    log.emit(Event::Kind::Recovery, -1, report.speed_limited).detail = EventDetail::SpeedLimited;
  if (report.put_back) log.emit(Event::Kind::Recovery).detail = EventDetail::Distorted;
  if (!isFinite(state)) {
    recover(model, state, log);
    report.contacts.clear();
  }
  if (model.tool && model.scene.scope->base_from_anatomy && state.step % lumenSteps(dt) == 0)
    reportLumen(model, poses.end[model.tip_link], state, log);
  if (stages != nullptr) report.stage_times = stages->stop();
}

}  // namespace vibe
