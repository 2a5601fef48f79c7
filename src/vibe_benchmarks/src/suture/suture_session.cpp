#include "suture/suture_session.hpp"

#include <algorithm>
#include <cmath>

#include "procedure/needle.hpp"
#include "procedure/thread_events.hpp"
#include "vibe_core/common/error.hpp"
#include "vibe_core/common/step_timer.hpp"
#include "vibe_core/model/accounting.hpp"

namespace vibe {
namespace {

constexpr double kStill = 1e-4;        // [m/s]
constexpr double kLongestSettle = 60;  // [s]
constexpr double kLongestPull = 15;    // more than the thread of any set here takes [s]
constexpr double kHold = 0.25;         // the cinch is held at its tension before it is let go [s]
constexpr double kNothing = 1e-9;      // of thread [m]

}  // namespace

double maxSpeed(const State& state) {
  double max = 0;
  for (std::size_t i = 0; i < state.vx.size(); ++i)
    max = std::max(max, std::hypot(state.vx[i], state.vy[i], state.vz[i]));
  return max;
}

SutureSession::SutureSession(std::shared_ptr<const Model> model, std::uint64_t seed)
    : model_(std::move(model)), state_(initialState(*model_, seed)), workspace_(*model_) {
  if (!model_->scene.gas || !model_->scene.suture || !model_->tool)
    throw Error("The scene '" + model_->scene.name +
                "' needs the sections gas, scope and suture to be sewn; add them.");
  input_.joints = state_.joints;
  input_.buttons[Insufflate] = 1;
  start_balance_ = energyBalance(*model_, state_);
}

void SutureSession::settle() {
  if (!calmDown(kLongestSettle))
    throw Error("The stomach does not come to rest at its pressure; lower gas.regulated_pressure or raise damping.");
}

bool SutureSession::calmDown(double longest) {
  const double end = state_.time + longest, target = model_->scene.gas->regulated_pressure;
  do {
    if (state_.time > end) return false;
    step(*model_, state_, input_, workspace_, events_);
  } while (std::abs(state_.pressure - target) > 1e-3 * target || maxSpeed(state_) > kStill);
  return true;
}

void SutureSession::takeBites(const std::vector<WallSpot>& spots) {
  Suture suture;
  suture.begin = state_.time;
  for (const WallSpot& spot : spots) {
    const Eigen::Vector3d place = placeOf(spot, wall());
    suture.bites.push_back(biteAround(*model_, wall(), spot.triangle, place, model_->scene.suture->bite_radius));
    suture.bites.back().depth = suture.bites.back().thickness;
    suture.bites.back().time = state_.time;
  }
  const auto where = [&](std::size_t k) { return bitePosition(suture.bites[k], state_.x, state_.y, state_.z); };
  for (std::size_t k = 1; k < spots.size(); ++k) suture.length.push_back((where(k) - where(k - 1)).norm());
  suture.tension.assign(suture.length.size(), 0.0);
  state_.procedure.sutures.push_back(std::move(suture));
}

void SutureSession::press(Button button, bool down, StepCosts& costs, SewnSet& set) {
  input_.buttons[button] = down ? 1 : 0;
  const double cpu = threadCpuTime(), wall = steadyTime();
  step(*model_, state_, input_, workspace_, events_);
  costs.cpu.push_back(1e3 * (threadCpuTime() - cpu));
  costs.wall.push_back(1e3 * (steadyTime() - wall));
  if (state_.solver.fallback > 0) ++set.fallback_steps;
  for (const Suture& suture : state_.procedure.sutures)
    for (double tension : suture.tension) set.max_tension = std::max(set.max_tension, tension);
}

void SutureSession::pull(SewnSet& set) {
  const SutureScene& scene = *model_->scene.suture;
  const int longest = static_cast<int>(kLongestPull / model_->scene.step_period);
  const int hold = static_cast<int>(kHold / model_->scene.step_period);
  for (int k = 0, held = 0; k < longest && held < hold; ++k) {
    const double before = state_.procedure.sutures.back().pulled;
    press(Cinch, true, set.pulling, set);
    const Suture& suture = state_.procedure.sutures.back();
    if (suture.permanent()) break;  // it broke
    const bool tight = cinchTension(suture) >= scene.cinch_tension, all_in = suture.pulled - before < kNothing;
    held = tight || all_in ? held + 1 : 0;
  }
  press(Cinch, false, set.pulling, set);
}

void SutureSession::count(std::size_t first_event, SewnSet& set) const {
  for (std::size_t k = first_event; k < events_.size(); ++k) {
    const Event::Kind kind = events_[k].kind;
    set.tear_outs += kind == Event::Kind::TearOut;
    set.breaks += kind == Event::Kind::ThreadBroke;
    set.recoveries += kind == Event::Kind::Recovery;
    set.refusals += kind == Event::Kind::Rejected;
    set.loose += kind == Event::Kind::CinchLoose;
  }
}

SewnSet SutureSession::sew(const std::vector<WallSpot>& spots, double after) {
  SewnSet set;
  const std::size_t first_event = events_.size();
  takeBites(spots);
  press(TTag, true, set.pulling, set);
  press(TTag, false, set.pulling, set);
  pull(set);
  const int steps = static_cast<int>(std::lround(after / model_->scene.step_period));
  for (int k = 0; k < steps; ++k) press(Cinch, false, set.after, set);
  const Suture& suture = state_.procedure.sutures.back();
  set.bites = static_cast<int>(suture.bites.size());
  set.technique = suture.technique;
  set.drawn = suture.pulled;
  set.tension = suture.cinch_tension;
  set.max_move = maxSpeed(state_);
  set.volume = state_.volume;
  set.balance = energyBalance(*model_, state_) - start_balance_;
  count(first_event, set);
  return set;
}

}  // namespace vibe
