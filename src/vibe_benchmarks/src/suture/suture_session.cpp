#include "suture/suture_session.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vibe_core/geometry/triangle_tree.hpp"
#include "vibe_core/model/accounting.hpp"
#include "vibe_core/procedure/stitch.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::benchmarks {

namespace {

constexpr double kStill = 1e-4;        // [m/s]
constexpr double kLongestSettle = 60;  // [s]
constexpr double kLongestPull = 15;    // longer than any set here needs [s]
constexpr double kHold = 0.25;         // time at the target tension before the cinch is released [s]
constexpr double kNothing = 1e-9;      // of thread [m]

}  // namespace

double maxSpeed(const State& state) {
  double max = 0;
  for (std::size_t i = 0; i < state.vx.size(); ++i)
    max = std::max(max, std::hypot(state.vx[i], state.vy[i], state.vz[i]));
  return max;
}

Suture sutureThrough(const Model& model, const SurfaceView& wall, const std::vector<WallPoint>& spots, double time) {
  Suture suture;
  suture.begin = time;
  for (const WallPoint& spot : spots) {
    suture.bites.push_back(
        biteAround(model, wall, spot.triangle, placeOf(spot, wall), model.scene.suture->bite_radius));
    suture.bites.back().depth = suture.bites.back().thickness;
    suture.bites.back().time = time;
  }
  const auto where = [&](std::size_t k) { return bitePosition(suture.bites[k], wall.x, wall.y, wall.z); };
  for (std::size_t k = 1; k < spots.size(); ++k) suture.length.push_back((where(k) - where(k - 1)).norm());
  suture.tension.assign(suture.length.size(), 0.0);
  return suture;
}

SutureSession::SutureSession(std::shared_ptr<const Model> model, std::uint64_t seed)
    : simulation_(std::move(model), SimulationSettings::study(seed)) {
  const Scene& scene = simulation_.model().scene;
  if (!scene.gas || !scene.suture || !simulation_.model().tool)
    throw Error("The scene '" + scene.name + "' needs the sections gas, scope and suture to be sewn; add them.");
  input_.joints = state().joints;
  input_.buttons[Insufflate] = 1;
  start_balance_ = energyBalance(simulation_.model(), state());
}

void SutureSession::step() {
  const std::vector<Event>& happened = simulation_.step(input_);
  events_.insert(events_.end(), happened.begin(), happened.end());
}

void SutureSession::settle() {
  if (!calmDown(kLongestSettle))
    throw Error("The stomach does not come to rest at its pressure; lower gas.regulated_pressure or raise damping.");
}

bool SutureSession::calmDown(double longest) {
  const double end = state().time + longest, target = model().scene.gas->regulated_pressure;
  do {
    if (state().time > end) return false;
    step();
  } while (std::abs(state().pressure - target) > 1e-3 * target || maxSpeed(state()) > kStill);
  return true;
}

void SutureSession::run(double duration) {
  const long steps = std::lround(duration / model().scene.step_period);
  for (long k = 0; k < steps; ++k) step();
}

void SutureSession::resume(const State& state) {
  simulation_.editState() = state;
}

void SutureSession::press(Button button, bool down, StepCosts& costs, SewnSet& set) {
  input_.buttons[button] = down ? 1 : 0;
  step();
  costs.cpu.push_back(1e3 * simulation_.timer().last_cpu);
  costs.wall.push_back(1e3 * simulation_.timer().last_wall);
  if (state().solver.backward_euler_steps > 0) ++set.fallback_steps;
  for (const Suture& suture : state().procedure.sutures)
    for (double tension : suture.tension) set.max_tension = std::max(set.max_tension, tension);
}

void SutureSession::pull(SewnSet& set, std::optional<double> drawn) {
  const SutureScene& scene = *model().scene.suture;
  const int longest = static_cast<int>(kLongestPull / model().scene.step_period);
  const int hold = static_cast<int>(kHold / model().scene.step_period);
  for (int k = 0, held = 0; k < longest && held < hold; ++k) {
    const double before = state().procedure.sutures.back().pulled;
    press(Cinch, true, set.pulling, set);
    const Suture& suture = state().procedure.sutures.back();
    if (suture.permanent()) break;  // the thread broke
    const bool tight = cinchTension(suture) >= scene.cinch_tension, all_in = suture.pulled - before < kNothing;
    held = tight || all_in ? held + 1 : 0;
    if (drawn && suture.pulled >= *drawn) break;
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

void SutureSession::tag(const std::vector<WallPoint>& spots) {
  SewnSet unused;
  tag(spots, unused);
}

void SutureSession::tag(const std::vector<WallPoint>& spots, SewnSet& set) {
  simulation_.editState().procedure.sutures.push_back(sutureThrough(model(), wall(), spots, state().time));
  press(TTag, true, set.pulling, set);
  press(TTag, false, set.pulling, set);
}

SewnSet SutureSession::sew(const std::vector<WallPoint>& spots, double after, std::optional<double> drawn) {
  SewnSet set;
  const std::size_t first_event = events_.size();
  tag(spots, set);
  pull(set, drawn);
  const int steps = static_cast<int>(std::lround(after / model().scene.step_period));
  for (int k = 0; k < steps; ++k) press(Cinch, false, set.after, set);
  const Suture& suture = state().procedure.sutures.back();
  set.bites = static_cast<int>(suture.bites.size());
  set.technique = suture.technique;
  set.drawn = suture.pulled;
  set.tension = suture.cinch_tension;
  set.max_move = maxSpeed(state());
  set.volume = state().volume;
  set.balance = energyBalance(model(), state()) - start_balance_;
  count(first_event, set);
  return set;
}

bool wallsCross(const Model& model, const State& state) {
  SurfaceMesh mesh = model.organ.surface;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) mesh.vertices[v] = {state.x[v], state.y[v], state.z[v]};
  return findSelfIntersection(TriangleTree(std::move(mesh))).first >= 0;
}

}  // namespace vibe::benchmarks
