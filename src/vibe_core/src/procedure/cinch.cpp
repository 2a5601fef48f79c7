#include "procedure/cinch.hpp"

#include "procedure/bleeding.hpp"
#include "procedure/phase.hpp"
#include "procedure/thread_events.hpp"
#include "vibe_core/events/event_log.hpp"
#include "vibe_core/procedure/cinch_model.hpp"
#include "vibe_core/suture/technique.hpp"

namespace vibe {

namespace {

int countSets(const State& state) {
  return static_cast<int>(state.procedure.sutures.size());
}

int countBites(const Suture& suture) {
  return static_cast<int>(suture.bites.size());
}

// None: the T-tag can be dropped.
RejectReason reasonAgainstTTag(const SutureScene& scene, const Suture* active, const ProcedureState& procedure) {
  if (!procedure.needle_loaded) return RejectReason::TTagDropped;
  if (!active) return RejectReason::NoBite;
  if (procedure.pierced && procedure.needle_on_arm) return RejectReason::NeedleInWall;
  return countBites(*active) < scene.min_bites ? RejectReason::TooFewBites : RejectReason::None;
}

// Of the last set.
Event& emitForSet(Event::Kind kind, double value, const State& state, EventLog log) {
  Event& event = log.emit(kind, -1, value);
  event.suture = countSets(state) - 1;
  return event;
}

// On the wall at rest: how the tissue is held now, and where earlier sets have moved it, does not matter.
void recognise(const Model& model, Suture& suture, const State& state, EventLog log) {
  const SutureScene& scene = *model.scene.suture;
  suture.taken.clear();
  for (const Bite& bite : suture.bites) suture.taken.push_back(restPosition(bite, model.organ.surface.vertices));
  const TechniqueResult corrected = recogniseTechnique(suture.taken, TechniqueRule::Corrected);
  const TechniqueResult printed = recogniseTechnique(suture.taken, TechniqueRule::Printed);
  const TechniqueResult& found = scene.classifier == "printed" ? printed : corrected;
  suture.corrected_technique = static_cast<std::uint8_t>(corrected.technique);
  suture.printed_technique = static_cast<std::uint8_t>(printed.technique);
  suture.technique = static_cast<std::uint8_t>(found.technique);
  suture.technique_margin = found.margin;
  suture.transitions = found.transitions;
  emitForSet(Event::Kind::TechniqueFound, static_cast<double>(found.technique), state, log);
}

// Called after the T-tag of the same step, so that a set tagged in this step can be cinched in it.
void beginCinch(const Model& model, Suture* active, State& state, EventLog log) {
  if (!active || active->stage == Suture::Stage::Open) {
    log.reject(Cinch, active ? RejectReason::NoTTag : RejectReason::NoThread);
    return;
  }
  active->stage = Suture::Stage::Cinching;
  if (model.cinch) model.cinch->begin(model, state, *active);
  emitForSet(Event::Kind::CinchPulling, 0, state, log);
}

void draw(const Model& model, const State& state, Suture& suture) {
  const double amount = model.scene.suture->cinch_speed * model.scene.step_period;
  if (model.cinch)
    model.cinch->draw(model, state, amount, suture);
  else
    drawThread(amount, suture);
}

void endCinch(const SutureScene& scene, State& state, EventLog log) {
  const int number = countSets(state) - 1;
  Suture& suture = state.procedure.sutures[number];
  suture.stage = Suture::Stage::Cinched;
  suture.cinch_tension = cinchTension(suture);
  suture.end = state.time;
  const bool loose = suture.cinch_tension < scene.loose_tension;
  Event& event = emitForSet(loose ? Event::Kind::CinchLoose : Event::Kind::Cinched, suture.cinch_tension, state, log);
  event.detail = suture.group.empty() ? EventDetail::ThreadDrawn : EventDetail::WallDrawn;
  event.amount = suture.pulled;
  if (!loose) stopBleedings(number, state, log);
  loadThread(state.procedure);
  enterPhase(Phase::Suture, state, log);
}

}  // namespace

void dropTTag(const Model& model, State& state, EventLog log) {
  ProcedureState& procedure = state.procedure;
  Suture* active = activeSuture(procedure);
  const SutureScene& scene = *model.scene.suture;
  const RejectReason reason = reasonAgainstTTag(scene, active, procedure);
  if (reason != RejectReason::None) {
    Event& event = log.reject(TTag, reason);
    if (reason != RejectReason::TooFewBites) return;
    event.amount = countBites(*active);
    event.limit = scene.min_bites;
    return;
  }
  active->stage = Suture::Stage::Tagged;
  procedure.needle_loaded = false;
  procedure.needle_on_arm = false;
  emitForSet(Event::Kind::TTagDropped, countBites(*active), state, log);
  recognise(model, *active, state, log);
  enterPhase(Phase::Pull, state, log);
}

void commandCinch(const Model& model, bool pressed, bool was_pressed, State& state, EventLog log) {
  const SutureScene& scene = *model.scene.suture;
  Suture* active = activeSuture(state.procedure);
  const bool cinching = active && active->stage == Suture::Stage::Cinching;
  if (cinching && !pressed) return endCinch(scene, state, log);
  if (pressed && !was_pressed && !cinching) beginCinch(model, active, state, log);
  if (!pressed || !active || active->stage != Suture::Stage::Cinching) return;
  if (cinchTension(*active) < scene.cinch_tension) draw(model, state, *active);
}

}  // namespace vibe
