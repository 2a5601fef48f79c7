#include "procedure/suturing.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "procedure/needle.hpp"
#include "procedure/procedure.hpp"
#include "vibe_core/events/event.hpp"
#include "vibe_core/procedure/procedure_registry.hpp"

namespace vibe {

namespace {

constexpr double kMet = 1.01 * kMinSegment;  // a segment no longer than this lies between bites that have met [m]

// Least share of the pull-out force that a bite holds, however shallow. Design choice without a published value:
// with a hold proportional to the depth alone, a bite that only just caught the mucosa would tear out at any tension.
constexpr double kMinHold = 0.25;

Eigen::Vector3d placeOf(const Bite& bite, const State& state) {
  return bitePosition(bite, state.x, state.y, state.z);
}

void lengthenToTissue(const State& state, Suture& suture) {
  for (std::size_t k = 0; k < suture.length.size(); ++k) {
    const double distance = (placeOf(suture.bites[k + 1], state) - placeOf(suture.bites[k], state)).norm();
    suture.length[k] = std::max(suture.length[k], distance);
  }
}

// The thread of the set no longer pulls. If the set was being cinched, the device takes a new thread.
void giveUp(Suture& suture, State& state, EventLog log) {
  const bool active = !suture.permanent();
  suture.stage = Suture::Stage::Broken;
  std::fill(suture.tension.begin(), suture.tension.end(), 0.0);
  if (!active) return;
  loadThread(state.procedure);
  enterPhase(Phase::Suture, state, log);
}

bool breakThread(const SutureScene& scene, int number, State& state, EventLog log) {
  Suture& suture = state.procedure.sutures[number];
  for (double& tension : suture.tension)
    if (!std::isfinite(tension)) tension = 0;
  const double max = *std::max_element(suture.tension.begin(), suture.tension.end());
  if (max <= scene.thread_strength) return false;
  Event& event = log.emit(Event::Kind::ThreadBroke, -1, max);
  event.suture = number;
  event.limit = scene.thread_strength;
  giveUp(suture, state, log);
  return true;
}

// The two segments at the bite become one. If it was the first or the last, the thread ends at its neighbour.
void removeBite(int bite, Suture& suture) {
  const int last = static_cast<int>(suture.bites.size()) - 1;
  const int segment = bite == 0 ? 0 : bite - 1;
  if (bite > 0 && bite < last) {
    suture.length[bite] += suture.length[segment];
    suture.tension[bite] = std::min(suture.tension[bite], suture.tension[segment]);
  }
  suture.length.erase(suture.length.begin() + segment);
  suture.tension.erase(suture.tension.begin() + segment);
  suture.bites.erase(suture.bites.begin() + bite);
  ++suture.tear_outs;
}

// Upper bound, as if both segments pulled in one direction. It is cheap and sufficient for most bites.
double maxForceOnBite(const Suture& suture, int bite) {
  const double before = bite > 0 ? suture.tension[bite - 1] : 0;
  return before + (bite + 1 < static_cast<int>(suture.bites.size()) ? suture.tension[bite] : 0);
}

// The bite with the highest ratio of force to hold above 1; -1: none. Sets `force` to the force on it.
int overloadedBite(const SutureScene& scene, const Suture& suture, const State& state, double& force) {
  int worst = -1;
  double max = 1;
  for (int b = 0; b < static_cast<int>(suture.bites.size()); ++b) {
    const double hold = holdOfBite(scene, suture.bites[b]);
    if (maxForceOnBite(suture, b) <= hold) continue;
    const double on_bite = forceOnBite(suture, b, state).norm();
    const double load = on_bite / hold;
    if (load <= max) continue;
    max = load;
    worst = b;
    force = on_bite;
  }
  return worst;
}

void tearOut(const SutureScene& scene, int number, State& state, EventLog log) {
  Suture& suture = state.procedure.sutures[number];
  double force = 0;
  const int bite = overloadedBite(scene, suture, state, force);
  if (bite < 0) return;
  Event& event = log.emit(Event::Kind::TearOut, nearestParticle(suture.bites[bite]), force);
  event.suture = number;
  event.bite = bite;
  event.limit = holdOfBite(scene, suture.bites[bite]);
  removeBite(bite, suture);
  forgetBite(number, bite, state.procedure);
  if (suture.bites.size() < 2) giveUp(suture, state, log);
}

}  // namespace

Suture* activeSuture(ProcedureState& procedure) {
  if (procedure.sutures.empty() || procedure.sutures.back().permanent()) return nullptr;
  return &procedure.sutures.back();
}

void loadThread(ProcedureState& procedure) {
  procedure.needle_loaded = true;
  procedure.needle_on_arm = true;
  procedure.pierced = false;
  procedure.pending = Bite{};
  procedure.thread_used = 0;
}

double drawThread(double amount, Suture& suture) {
  double left = amount;
  for (double& length : suture.length) {
    const double drawn = std::clamp(length - kMinSegment, 0.0, left);
    length -= drawn;
    left -= drawn;
  }
  suture.pulled += amount - left;
  return amount - left;
}

double cinchTension(const Suture& suture) {
  double max = 0;
  for (std::size_t k = 0; k < suture.tension.size(); ++k) {
    max = std::max(max, suture.tension[k]);
    if (suture.length[k] > kMet) break;
  }
  return max;
}

Eigen::Vector3d forceOnBite(const Suture& suture, int bite, const State& state) {
  const Eigen::Vector3d place = placeOf(suture.bites[bite], state);
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  const auto add = [&](int segment, int neighbour) {
    const Eigen::Vector3d along = placeOf(suture.bites[neighbour], state) - place;
    const double length = along.norm();
    if (length > 0) force += suture.tension[segment] / length * along;
  };
  if (bite > 0) add(bite - 1, bite - 1);
  if (bite + 1 < static_cast<int>(suture.bites.size())) add(bite, bite + 1);
  return force;
}

double holdOfBite(const SutureScene& scene, const Bite& bite) {
  return scene.pull_out_force * std::clamp(bite.depth / bite.thickness, kMinHold, 1.0);
}

void updateThreads(const Model& model, State& state, EventLog log) {
  const SutureScene& scene = *model.scene.suture;
  ProcedureState& procedure = state.procedure;
  if (Suture* active = activeSuture(procedure)) {
    const bool open = active->stage == Suture::Stage::Open;
    if (open || active->stage == Suture::Stage::Tagged) lengthenToTissue(state, *active);
    if (open) procedure.thread_used = std::accumulate(active->length.begin(), active->length.end(), 0.0);
  }
  for (int number = 0; number < static_cast<int>(procedure.sutures.size()); ++number) {
    if (!procedure.sutures[number].pulls()) continue;
    if (!breakThread(scene, number, state, log)) tearOut(scene, number, state, log);
  }
}

void slackenThreads(const Model& model, State& state) {
  for (Suture& suture : state.procedure.sutures) {
    lengthenToTissue(state, suture);
    if (model.cinch) model.cinch->slacken(state, suture);
    std::fill(suture.tension.begin(), suture.tension.end(), 0.0);
  }
}

}  // namespace vibe
