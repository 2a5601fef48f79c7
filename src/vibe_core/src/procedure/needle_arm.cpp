#include "procedure/needle_arm.hpp"

#include <algorithm>
#include <string>

#include "procedure/bleeding.hpp"
#include "procedure/emit_event.hpp"
#include "procedure/needle.hpp"
#include "procedure/phase.hpp"
#include "procedure/thread_events.hpp"

namespace vibe {

namespace {

constexpr double kClosed = 0.95;  // of the joint's range; apart, so that a tremor does not open and close the arm
constexpr double kOpen = 0.10;
constexpr double kMinNewSegment = 1e-3;  // [m]

void meetTissue(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, State& state,
                std::vector<Event>& events) {
  const auto [begin, end] = needlePath(model, link_poses);
  NeedleReach reach = reachOfNeedle(model, state, begin, end);
  if (reach.depth <= 0) {
    emitEvent(Event::Kind::BiteMissed, state.time, -1, -reach.depth,
              "The needle met no tissue, it passed the wall by " + inMillimetres(-reach.depth) +
                  "; draw more of it in with the helix.",
              events);
    return;
  }
  ProcedureState& procedure = state.procedure;
  procedure.pierced = true;
  procedure.pending = std::move(reach.bite);
  emitEvent(Event::Kind::Pierced, state.time, nearestParticle(procedure.pending), reach.depth,
            "The needle is " + inMillimetres(reach.depth) + " deep in the wall; hand it to the anchor exchange.",
            events);
  noteSuturing(state, events);
}

void closeArm(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, State& state,
              std::vector<Event>& events) {
  state.procedure.arm_closed = true;
  if (!state.procedure.needle_loaded)
    reject(-1, state.time,
           "The arm closed without a needle, which went with the T-tag: cinch the set to get a new one.", events);
  else if (state.procedure.needle_on_arm)
    meetTissue(model, link_poses, state, events);
  else
    emitEvent(Event::Kind::ArmClosed, state.time, -1, 0,
              "The arm closed over the anchor exchange, which holds the needle and can hand it back.", events);
}

void openArm(State& state, std::vector<Event>& events) {
  ProcedureState& procedure = state.procedure;
  procedure.arm_closed = false;
  const bool withdrawn = procedure.pierced && procedure.needle_on_arm;
  procedure.pierced = false;
  if (!withdrawn) return;
  emitEvent(Event::Kind::BiteWithdrawn, state.time, nearestParticle(procedure.pending), 0,
            "The needle was drawn back out of the wall: no bite, the anchor exchange did not have it yet.", events);
  procedure.pending = Bite{};
}

double distanceFromLast(const Suture* open, const State& state) {
  if (!open || open->bites.empty()) return 0;
  const Eigen::Vector3d last = bitePosition(open->bites.back(), state.x, state.y, state.z);
  return (bitePosition(state.procedure.pending, state.x, state.y, state.z) - last).norm();
}

// Empty: nothing stands against the bite.
std::string reasonAgainstBite(const SutureScene& scene, const Suture* open, double spacing, const State& state) {
  if (!open && static_cast<int>(state.procedure.sutures.size()) >= kMaxSutures)
    return "A session holds " + std::to_string(kMaxSutures) + " sets, and all are used: reset to begin anew.";
  if (!open) return "";
  if (static_cast<int>(open->bites.size()) >= scene.max_bites)
    return "The set has its " + std::to_string(scene.max_bites) +
           " bites: open the arm to withdraw the needle, then drop the T-tag.";
  if (state.procedure.thread_used + spacing > scene.thread_length)
    return "The thread is used up, " + inMillimetres(scene.thread_length - state.procedure.thread_used) +
           " are left and this bite needs " + inMillimetres(spacing) +
           ": open the arm to withdraw the needle, then drop the T-tag.";
  return "";
}

std::string biteText(const Bite& bite, int bite_number, int set_number, double spacing) {
  std::string text = "Bite " + std::to_string(bite_number) + " of set " + std::to_string(set_number) + ": " +
                     (bite.fullThickness() ? "full" : "partial") + " thickness, " + inMillimetres(bite.depth) +
                     " deep, " + toString(bite.region) + ", " + toString(bite.wall) + " wall";
  if (bite_number > 1) text += ", " + inMillimetres(spacing) + " from the bite before";
  return text + ".";
}

void takeBite(const Model& model, State& state, std::vector<Event>& events) {
  ProcedureState& procedure = state.procedure;
  Suture* open = activeSuture(procedure);  // open, as there is a needle
  const double spacing = distanceFromLast(open, state);
  const std::string reason = reasonAgainstBite(*model.scene.suture, open, spacing, state);
  if (!reason.empty()) return reject(Needle, state.time, reason, events);
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
  const int particle = nearestParticle(open->bites.back());
  emitEvent(Event::Kind::Bite, state.time, particle, open->bites.back().depth,
            biteText(open->bites.back(), number + 1, set + 1, spacing), events);
  noteSuturing(state, events);
  bleedFromBite(model, set, number, particle, state, events);
}

}  // namespace

void updateArm(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, State& state,
               std::vector<Event>& events) {
  const JointLimits& limits = model.tool->limits()[NeedleDriver];
  const double closed = (state.joints[NeedleDriver] - limits.lower) / (limits.upper - limits.lower);
  if (!state.procedure.arm_closed && closed >= kClosed) closeArm(model, link_poses, state, events);
  if (state.procedure.arm_closed && closed <= kOpen) openArm(state, events);
}

void exchangeNeedle(const Model& model, State& state, std::vector<Event>& events) {
  ProcedureState& procedure = state.procedure;
  if (!procedure.needle_loaded)
    return reject(Needle, state.time, "There is no needle, it went with the T-tag: cinch the set to get a new one.",
                  events);
  if (!procedure.arm_closed)
    return reject(Needle, state.time, "The arm is open and meets the anchor exchange only when closed: close it first.",
                  events);
  if (procedure.pierced && procedure.needle_on_arm) return takeBite(model, state, events);
  if (procedure.pierced)
    return reject(Needle, state.time,
                  "The arm is still in the bite just taken: open and close it before the needle comes back to it.",
                  events);
  procedure.needle_on_arm = !procedure.needle_on_arm;
  emitEvent(Event::Kind::NeedleExchanged, state.time, -1, procedure.needle_on_arm ? 1 : 0,
            procedure.needle_on_arm ? "The arm holds the needle." : "The anchor exchange holds the needle.", events);
}

}  // namespace vibe
