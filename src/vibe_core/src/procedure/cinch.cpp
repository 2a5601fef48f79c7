#include "procedure/cinch.hpp"
#include "constraints/group_draw.hpp"

#include <string>

#include "procedure/bleeding.hpp"
#include "procedure/emit_event.hpp"
#include "procedure/phase.hpp"
#include "procedure/thread_events.hpp"
#include "vibe_core/suture/technique.hpp"

namespace vibe {

namespace {

// Empty: nothing stands against it.
std::string reasonAgainstTTag(const SutureScene& scene, const Suture* active, const ProcedureState& procedure) {
  if (!procedure.needle_loaded)
    return "The T-tag of this set is dropped already: hold the cinch until the set is tight, then let it go.";
  if (!active) return "There is no bite that a T-tag could hold: take bites first.";
  if (procedure.pierced && procedure.needle_on_arm)
    return "The needle is in the wall: hand it to the anchor exchange, or open the arm, before dropping the T-tag.";
  const int bites = static_cast<int>(active->bites.size());
  if (bites < scene.min_bites)
    return "The set has too few bites, " + std::to_string(bites) + " of " + std::to_string(scene.min_bites) +
           ": take more before dropping the T-tag.";
  return "";
}

void recognise(const SutureScene& scene, Suture& suture, const State& state, std::vector<Event>& events) {
  suture.taken.clear();
  for (const Bite& bite : suture.bites) suture.taken.push_back(bitePosition(bite, state.x, state.y, state.z));
  const TechniqueRule rule = scene.classifier == "printed" ? TechniqueRule::Printed : TechniqueRule::Corrected;
  const TechniqueResult found = recogniseTechnique(suture.taken, rule);
  suture.technique = static_cast<std::uint8_t>(found.technique);
  suture.technique_margin = found.margin;
  suture.transitions = found.transitions;
  emitEvent(Event::Kind::TechniqueFound, state.time, -1, static_cast<double>(found.technique),
            "The bites of set " + std::to_string(state.procedure.sutures.size()) + " form the pattern '" +
                toString(found.technique) + "'.",
            events);
}

// Called after the T-tag of the step, so that a suture that can be cinched is found in the same step.
void beginCinch(const Model& model, Suture* active, State& state, std::vector<Event>& events) {
  if (!active)
    return reject(Cinch, state.time, "There is no thread to cinch: take bites and drop the T-tag first.", events);
  if (active->stage == Suture::Stage::Open)
    return reject(Cinch, state.time, "The thread has no hold at its end yet: drop the T-tag before the cinch.", events);
  active->stage = Suture::Stage::Cinching;
  if (model.scene.suture->cinch_model == "groups") findGroup(model, state, *active);
  emitEvent(Event::Kind::CinchPulling, state.time, -1, 0,
            "The cinch draws the thread of set " + std::to_string(state.procedure.sutures.size()) + ".", events);
}

// Thread, or where the prototype's way is chosen the set's particles as far as the wall bears it.
void draw(const Model& model, const State& state, Suture& suture) {
  const SutureScene& scene = *model.scene.suture;
  const double amount = scene.cinch_speed * model.scene.step_period;
  if (scene.cinch_model == "thread")
    drawThread(amount, suture);
  else if (groupStrain(model, state, suture.group) < scene.strain_limit)
    drawGroup(amount, suture);
}

void endCinch(const SutureScene& scene, State& state, std::vector<Event>& events) {
  const int number = static_cast<int>(state.procedure.sutures.size()) - 1;
  Suture& suture = state.procedure.sutures[number];
  suture.stage = Suture::Stage::Cinched;
  suture.cinch_tension = cinchTension(suture);
  suture.end = state.time;
  const bool loose = suture.cinch_tension < scene.loose_tension;
  emitEvent(loose ? Event::Kind::CinchLoose : Event::Kind::Cinched, state.time, -1, suture.cinch_tension,
            "Set " + std::to_string(number + 1) + (loose ? " is cinched loosely at " : " is cinched at ") +
                inNewtons(suture.cinch_tension) + ", " +
                (suture.group.empty() ? inMillimetres(suture.pulled) + " of thread were drawn."
                                      : "the wall was drawn by " + inMillimetres(suture.pulled) + "."),
            events);
  if (!loose) stopBleedings(number, state, events);
  loadThread(state.procedure);
  enterPhase(Phase::Suture, state, events);
}

}  // namespace

void dropTTag(const Model& model, State& state, std::vector<Event>& events) {
  ProcedureState& procedure = state.procedure;
  Suture* active = activeSuture(procedure);
  const std::string reason = reasonAgainstTTag(*model.scene.suture, active, procedure);
  if (!reason.empty()) return reject(TTag, state.time, reason, events);
  active->stage = Suture::Stage::Tagged;
  procedure.needle_loaded = false;
  procedure.needle_on_arm = false;
  const int bites = static_cast<int>(active->bites.size());
  emitEvent(
      Event::Kind::TTagDropped, state.time, -1, bites,
      "The T-tag holds set " + std::to_string(procedure.sutures.size()) + " of " + std::to_string(bites) + " bites.",
      events);
  recognise(*model.scene.suture, *active, state, events);
  enterPhase(Phase::Pull, state, events);
}

void commandCinch(const Model& model, bool pressed, bool was_pressed, State& state, std::vector<Event>& events) {
  const SutureScene& scene = *model.scene.suture;
  Suture* active = activeSuture(state.procedure);
  const bool cinching = active && active->stage == Suture::Stage::Cinching;
  if (cinching && !pressed) return endCinch(scene, state, events);
  if (pressed && !was_pressed && !cinching) beginCinch(model, active, state, events);
  if (!pressed || !active || active->stage != Suture::Stage::Cinching) return;
  if (cinchTension(*active) < scene.cinch_tension) draw(model, state, *active);
}

}  // namespace vibe
