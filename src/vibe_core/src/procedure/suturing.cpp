#include "procedure/suturing.hpp"

#include <algorithm>

#include "procedure/needle.hpp"
#include "procedure/procedure.hpp"
#include "vibe_core/events/event.hpp"
#include "vibe_core/procedure/procedure_registry.hpp"
#include "vibe_core/suture/technique.hpp"

namespace vibe {

namespace {

// Of the range of the joint. Hysteresis with kClosedShare: a tremor must not open and close the arm; design choice.
constexpr double kOpen = 0.10;
constexpr double kMinNewSegment = 1e-3;  // so that two bites at one place have thread between them; design choice [m]

void meetTissue(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, State& state, EventLog log) {
  const auto [begin, end] = needlePath(model, link_poses);
  NeedleReach reach = reachOfNeedle(model, state, begin, end);
  if (reach.depth <= 0) {
    log.emit(Event::Kind::BiteMissed, -1, -reach.depth);
    return;
  }
  ProcedureState& procedure = state.procedure;
  procedure.pierced = true;
  procedure.pending = std::move(reach.bite);
  log.emit(Event::Kind::Pierced, nearestParticle(procedure.pending), reach.depth);
  noteSuturing(state, log);
}

void closeArm(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, State& state, EventLog log) {
  state.procedure.arm_closed = true;
  if (!state.procedure.needle_loaded)
    log.reject(-1, RejectReason::ClosedWithoutNeedle);
  else if (state.procedure.needle_on_arm)
    meetTissue(model, link_poses, state, log);
  else
    log.emit(Event::Kind::ArmClosed);
}

void openArm(State& state, EventLog log) {
  ProcedureState& procedure = state.procedure;
  procedure.arm_closed = false;
  const bool withdrawn = procedure.pierced && procedure.needle_on_arm;
  procedure.pierced = false;
  if (!withdrawn) return;
  log.emit(Event::Kind::BiteWithdrawn, nearestParticle(procedure.pending), 0);
  procedure.pending = Bite{};
}

double distanceFromLast(const Suture* open, const State& state) {
  if (!open || open->bites.empty()) return 0;
  const Eigen::Vector3d last = bitePosition(open->bites.back(), state.x, state.y, state.z);
  return (bitePosition(state.procedure.pending, state.x, state.y, state.z) - last).norm();
}

// True, with an event, if the bite cannot be taken.
bool rejectBite(const SutureScene& scene, const Suture* open, double spacing, const State& state, EventLog log) {
  const auto no = [&](RejectReason reason, double limit) {
    Event& event = log.reject(Needle, reason);
    event.limit = limit;
    event.amount = spacing;
    return true;
  };
  if (!open) {
    const bool full = static_cast<int>(state.procedure.sutures.size()) >= kMaxSutures;
    return full && no(RejectReason::TooManySets, kMaxSutures);
  }
  if (static_cast<int>(open->bites.size()) >= scene.max_bites) return no(RejectReason::SetFull, scene.max_bites);
  const bool too_long = state.procedure.thread_used + spacing > scene.thread_length;
  return too_long && no(RejectReason::ThreadUsedUp, scene.thread_length - state.procedure.thread_used);
}

void emitBite(const Bite& bite, int set, int number, double spacing, EventLog log) {
  Event& event = log.emit(Event::Kind::Bite, nearestParticle(bite), bite.depth);
  event.detail = bite.fullThickness() ? EventDetail::FullThickness : EventDetail::PartialThickness;
  event.suture = set;
  event.bite = number;
  event.amount = spacing;
  event.region = bite.region;
  event.wall = bite.wall;
}

void takeBite(const Model& model, State& state, EventLog log) {
  ProcedureState& procedure = state.procedure;
  Suture* open = activeSuture(procedure);  // open, as there is a needle
  const double spacing = distanceFromLast(open, state);
  if (rejectBite(*model.scene.suture, open, spacing, state, log)) return;
  if (!open) {
    open = &procedure.sutures.emplace_back();
    open->begin = state.time;
  }
  Bite bite = std::move(procedure.pending);
  procedure.pending = Bite{};
  procedure.needle_on_arm = false;
  bite.time = state.time;
  if (!open->bites.empty()) {
    open->length.push_back(std::max(spacing, kMinNewSegment));
    open->tension.push_back(0);
    procedure.thread_used += open->length.back();
  }
  open->bites.push_back(std::move(bite));
  const int set = static_cast<int>(procedure.sutures.size()) - 1, number = static_cast<int>(open->bites.size()) - 1;
  emitBite(open->bites.back(), set, number, spacing, log);
  noteSuturing(state, log);
  bleedFromBite(model, set, number, nearestParticle(open->bites.back()), state, log);
}

// None: the needle can change sides.
RejectReason reasonAgainstExchange(const ProcedureState& procedure) {
  if (!procedure.needle_loaded) return RejectReason::NoNeedle;
  if (!procedure.arm_closed) return RejectReason::ArmOpen;
  return procedure.pierced ? RejectReason::ArmStillInBite : RejectReason::None;
}

}  // namespace

void updateArm(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, State& state, EventLog log) {
  const JointLimits& limits = model.tool->limits()[NeedleDriver];
  const double closed = (state.joints[NeedleDriver] - limits.lower) / (limits.upper - limits.lower);
  if (!state.procedure.arm_closed && closed >= kClosedShare) closeArm(model, link_poses, state, log);
  if (state.procedure.arm_closed && closed <= kOpen) openArm(state, log);
}

void exchangeNeedle(const Model& model, State& state, EventLog log) {
  ProcedureState& procedure = state.procedure;
  const bool bites = procedure.needle_loaded && procedure.arm_closed && procedure.pierced && procedure.needle_on_arm;
  if (bites) return takeBite(model, state, log);
  const RejectReason reason = reasonAgainstExchange(procedure);
  if (reason != RejectReason::None) {
    log.reject(Needle, reason);
    return;
  }
  procedure.needle_on_arm = !procedure.needle_on_arm;
  log.emit(Event::Kind::NeedleExchanged, -1, procedure.needle_on_arm ? 1 : 0).detail =
      procedure.needle_on_arm ? EventDetail::NeedleOnArm : EventDetail::NeedleInExchange;
}

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
