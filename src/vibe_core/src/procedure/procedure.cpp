#include "procedure/procedure.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "procedure/suturing.hpp"
#include "vibe_core/arithmetic/random.hpp"
#include "vibe_core/events/event.hpp"

namespace vibe {

namespace {

// Hysteresis: a tremor of the hand at the entry must not end the procedure again and again; design choice [m].
constexpr double kWithdrawn = 0.01;
constexpr double kInserted = 0.02;

bool everySetIsFinished(const ProcedureState& procedure) {
  bool cinched = false;
  for (const Suture& suture : procedure.sutures) {
    if (!suture.permanent()) return false;
    cinched |= suture.stage == Suture::Stage::Cinched;
  }
  return cinched;
}

}  // namespace

void enterPhase(Phase phase, State& state, EventLog log) {
  if (state.procedure.phase == phase) return;
  state.procedure.phase = phase;
  log.emit(Event::Kind::PhaseChanged, -1, static_cast<double>(phase));
}

void noteMarking(State& state, EventLog log) {
  if (state.procedure.phase != Phase::Pull) enterPhase(Phase::Mark, state, log);
}

void noteSuturing(State& state, EventLog log) {
  if (state.procedure.phase != Phase::Pull) enterPhase(Phase::Suture, state, log);
}

void updatePhase(const Model& model, State& state, EventLog log) {
  const double insertion = state.joints[Insertion] - model.tool->limits()[Insertion].lower;
  const bool done = state.procedure.phase == Phase::Done;
  const bool at_work = state.procedure.arm_closed || !state.grip.empty();
  if (!done && !at_work && insertion < kWithdrawn && everySetIsFinished(state.procedure))
    enterPhase(Phase::Done, state, log);
  if (done && insertion > kInserted) enterPhase(Phase::Inspect, state, log);
}

namespace {

constexpr double kReached = 0.01, kLost = 0.05;  // parts of the set point
constexpr double kMinReached = 1, kMinLost = 5;  // of low set points [Pa]

}  // namespace

bool isAtSetPoint(double pressure, double set_point, bool was) {
  const double part = was ? kLost : kReached, min = was ? kMinLost : kMinReached;
  return std::abs(pressure - set_point) < std::max(min, part * std::abs(set_point));
}

namespace {

constexpr double kRounding = 1e-9;  // tolerance for the rounding of times that are sums of steps [s]

Event& emitBleeding(Event::Kind kind, const Bleeding& bleeding, double value, EventLog log) {
  Event& event = log.emit(kind, bleeding.particle, value);
  event.suture = bleeding.suture;
  event.bite = bleeding.bite;
  return event;
}

void stop(Bleeding& bleeding, EventDetail how, EventLog log) {
  bleeding.rate = 0;
  emitBleeding(Event::Kind::BleedingStopped, bleeding, bleeding.amount, log).detail = how;
}

}  // namespace

void bleedFromBite(const Model& model, int suture, int bite, int particle, State& state, EventLog log) {
  if (!model.scene.bleeding) return;
  const BleedingScene& scene = *model.scene.bleeding;
  const double draw = nextUniform(state.random);
  if (draw >= scene.brisk_probability + scene.mild_probability) return;
  Bleeding bleeding;
  bleeding.suture = suture;
  bleeding.bite = bite;
  bleeding.particle = particle;
  bleeding.brisk = draw < scene.brisk_probability;
  bleeding.begin = state.time;
  bleeding.rate = bleeding.brisk ? scene.brisk_rate : scene.mild_rate;
  emitBleeding(bleeding.brisk ? Event::Kind::BleedingBrisk : Event::Kind::BleedingMild, bleeding, bleeding.rate, log);
  state.procedure.bleedings.push_back(bleeding);
}

void updateBleedings(const Model& model, State& state, EventLog log) {
  if (!model.scene.bleeding) return;
  const BleedingScene& scene = *model.scene.bleeding;
  for (Bleeding& bleeding : state.procedure.bleedings) {
    if (bleeding.rate <= 0) continue;
    const double lost = bleeding.rate * model.scene.step_period;
    bleeding.amount += lost;
    state.procedure.blood_lost += lost;
    const double age = state.time - bleeding.begin + kRounding;
    if (!bleeding.brisk && age >= scene.mild_duration) stop(bleeding, EventDetail::MildByItself, log);
    if (!bleeding.brisk || bleeding.overdue || age < scene.brisk_time) continue;
    bleeding.overdue = true;
    emitBleeding(Event::Kind::BleedingOverdue, bleeding, bleeding.amount, log);
  }
}

void stopBleedings(int suture, State& state, EventLog log) {
  for (Bleeding& bleeding : state.procedure.bleedings) {
    if (bleeding.suture != suture || bleeding.rate <= 0) continue;
    stop(bleeding, bleeding.brisk ? EventDetail::BriskCinched : EventDetail::MildCinched, log);
  }
}

void forgetBite(int suture, int bite, ProcedureState& procedure) {
  for (Bleeding& bleeding : procedure.bleedings) {
    if (bleeding.suture != suture) continue;
    if (bleeding.bite == bite)
      bleeding.bite = -1;
    else if (bleeding.bite > bite)
      --bleeding.bite;
  }
}

namespace {

// None: the scene has the section that the button needs.
RejectReason missingSection(const Model& model, int button) {
  const Scene& scene = model.scene;
  if (button == Insufflate) return scene.gas ? RejectReason::None : RejectReason::NoGas;
  if (!model.tool) return RejectReason::NoScope;
  switch (button) {
    case ApcPedal:
      return scene.marking ? RejectReason::None : RejectReason::NoMarking;
    case HelixGrab:
      return scene.helix ? RejectReason::None : RejectReason::NoHelix;
    case Needle:
    case TTag:
    case Cinch:
      return scene.suture ? RejectReason::None : RejectReason::NoSuture;
    default:
      return RejectReason::None;
  }
}

void rejectWithoutSection(const Model& model, const StepInput& input, const State& state, EventLog log) {
  for (int button = 0; button < kButtonCount; ++button) {
    if (input.buttons[button] == 0 || state.procedure.pressed[button] != 0) continue;
    const RejectReason reason = missingSection(model, button);
    if (reason != RejectReason::None) log.reject(button, reason);
  }
}

}  // namespace

void commandProcedure(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, const StepInput& input,
                      State& state, EventLog log) {
  rejectWithoutSection(model, input, state, log);
  const std::array<std::uint8_t, kButtonCount> before = state.procedure.pressed;
  const auto wentDown = [&](Button button) { return input.buttons[button] != 0 && before[button] == 0; };
  // several in one step act in the order needle, T-tag, cinch; each sees the effect of the one before
  if (model.scene.suture && model.tool) {
    updateArm(model, link_poses, state, log);
    if (wentDown(Needle)) exchangeNeedle(model, state, log);
    if (wentDown(TTag)) dropTTag(model, state, log);
    commandCinch(model, input.buttons[Cinch] != 0, before[Cinch] != 0, state, log);
  }
  for (int button = 0; button < kButtonCount; ++button)
    state.procedure.pressed[button] = input.buttons[button] != 0 ? 1 : 0;
}

void updateProcedure(const Model& model, State& state, EventLog log) {
  if (!model.scene.suture || !model.tool) return;
  updateThreads(model, state, log);
  updateBleedings(model, state, log);
  updatePhase(model, state, log);
}

}  // namespace vibe
