#include "procedure/phase.hpp"

#include "vibe_core/events/event_log.hpp"

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

}  // namespace vibe
