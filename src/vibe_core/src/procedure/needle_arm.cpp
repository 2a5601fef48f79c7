#include "procedure/needle_arm.hpp"

#include <algorithm>

#include "procedure/bleeding.hpp"
#include "procedure/needle.hpp"
#include "procedure/phase.hpp"
#include "procedure/thread_events.hpp"
#include "vibe_core/events/event_log.hpp"

namespace vibe {

namespace {

// Of the range of the joint. Hysteresis: a tremor must not open and close the arm; design choice.
constexpr double kClosed = 0.95;
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
  if (!state.procedure.arm_closed && closed >= kClosed) closeArm(model, link_poses, state, log);
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

}  // namespace vibe
