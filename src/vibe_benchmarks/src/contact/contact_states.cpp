#include "contact/contact_table.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "contact/bench_tools.hpp"
#include "suture/suture_session.hpp"
#include "suture/wall_plan.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::benchmarks {
namespace {

constexpr double kPull = 0.02;           // [m]
constexpr double kMotion = 0.5;          // time of a motion, at constant speed [s]
constexpr double kHold = 0.5;            // after it [s]
constexpr double kPressDepth = 18.5e-3;  // deeper than at first contact [m]
constexpr std::size_t kFoldSet = 2;      // of six
constexpr double kFoldPull = 0.015;      // before the wound fold is measured [m]
constexpr double kFoldTurn = M_PI / 4;   // likewise [rad]
constexpr double kMorePull = 0.01;       // while it is measured [m]
constexpr double kMoreTurn = M_PI / 6;   // likewise [rad]
constexpr double kCinch = 3.5;           // longer than a set here needs [s]

/// Part of a motion that is done at a time.
double part(double time, double duration) {
  return std::clamp(time / duration, 0.0, 1.0);
}

/// Steps with an input that may depend on the time since now.
void stepFor(double duration, const std::function<StepInput(double end)>& input, Simulation& simulation) {
  const int steps = static_cast<int>(std::lround(duration / simulation.stepPeriod()));
  for (int k = 1; k <= steps; ++k) simulation.step(input(k * simulation.stepPeriod()));
}

}  // namespace

const std::vector<std::string>& contactStateNames() {
  static const std::vector<std::string> kNames{"free", "free_closed", "pressed", "wound", "cinch1", "cinch6"};
  return kNames;
}

std::string describeContactStates() {
  return "  free         a patch of the greater curvature, held by the helix, is pulled inwards by 20 mm in 0.5 s and\n"
         "               held for 0.5 s; insufflator on\n"
         "  free_closed  the same, insufflator off\n"
         "  pressed      the scope, straight, presses the wall by 18.5 mm in 0.5 s and stays for 0.5 s\n"
         "  wound        the fold of a cinched set, pulled by 15 mm and turned by 45 degrees, is pulled by 10 mm and "
         "turned\n"
         "               by 30 degrees more in 0.5 s, and held for 0.5 s\n"
         "  cinch1       the first of six sets of 7 bites is cinched\n"
         "  cinch6       the sixth, after five\n";
}

ContactStates::ContactStates(const Scene& scene, std::string urdf, std::ostream& log)
    : model_(buildModel(scene, urdf)), urdf_(std::move(urdf)), log_(log) {
  log_ << "insufflation\n";
  SutureSession session(model_);
  session.settle();
  settled_ = session.state();
  startClock(settled_);
}

ContactCase ContactStates::prepare(const std::string& name) {
  log_ << name << ": preparation" << std::endl;
  const std::map<std::string, std::function<ContactCase()>> makers{
      {"free", [&] { return pull(true); }},   {"free_closed", [&] { return pull(false); }},
      {"pressed", [&] { return pressed(); }}, {"wound", [&] { return wound(); }},
      {"cinch1", [&] { return cinch(0); }},   {"cinch6", [&] { return cinch(5); }}};
  const auto maker = makers.find(name);
  if (maker == makers.end()) throw Error("There is no state '" + name + "'; the program's help names those there are.");
  ContactCase one = maker->second();
  one.name = name;
  startClock(one.start);
  return one;
}

// A state with a free hand at a place of the wall that has not taken hold yet.
ContactCase ContactStates::byHand(const State& state, const WallPoint& spot) const {
  ContactCase one;
  const SurfaceView wall{model_->organ.surface.triangles, state.x, state.y, state.z};
  const Eigen::Vector3d place = placeOf(spot, wall);
  Scene scene = model_->scene;
  holdByHand(place, inwardsAt(wall, place), scene);
  one.urdf = freeHandUrdf();
  one.model = modelWith(scene, one.urdf, *model_);
  one.start = state;
  one.start.joints = {};
  one.start.joints[Insertion] = kHandStart;
  return one;
}

ContactCase ContactStates::pull(bool insufflator) const {
  const SurfaceView wall{model_->organ.surface.triangles, settled_.x, settled_.y, settled_.z};
  const WallPlan plan(model_->organ, wall);
  ContactCase one = byHand(settled_, plan.at(0.5 * plan.length(), 0));
  one.duration = kMotion + kHold;
  StepInput held = holdAt(one.start);
  held.buttons[HelixGrab] = 1;
  held.buttons[Insufflate] = insufflator ? 1 : 0;
  one.input = [held](double end) {
    StepInput input = held;
    input.joints[Insertion] += kPull * part(end, kMotion);
    return input;
  };
  return one;
}

ContactCase ContactStates::pressed() const {
  ContactCase one;
  one.model = model_;
  one.urdf = urdf_;
  one.duration = kMotion + kHold;
  one.start = settled_;
  StepInput input = holdAt(settled_);
  input.joints[Insertion] = insertionAtContact(model_, one.start) - kClearance;
  one.input = [input](double end) {
    StepInput now = input;
    now.joints[Insertion] += (kClearance + kPressDepth) * part(end, kMotion);
    return now;
  };
  return one;
}

// A set is cinched; the hand takes hold of its fold.
ContactCase ContactStates::wound() const {
  SutureSession session(model_);
  session.settle();
  const auto spots = planSets(WallPlan(model_->organ, session.wall()), SetLayout())[kFoldSet];
  session.sew(spots);
  ContactCase one = byHand(session.state(), spots[spots.size() / 2]);
  one.duration = kMotion + kHold;
  StepInput held = holdAt(one.start);
  held.buttons[HelixGrab] = 1;
  const auto pulled = [held](double time) {
    StepInput input = held;
    input.joints[Insertion] += kFoldPull * part(time, 1);
    input.joints[Rotation] += kFoldTurn * part(time, 1);
    return input;
  };
  Simulation simulation(one.model, SimulationSettings::study(1));
  simulation.replaceState(one.start);
  stepFor(
      0.1, [&](double) { return held; }, simulation);
  stepFor(2, pulled, simulation);
  one.start = simulation.state();
  if (one.start.grip.empty()) throw Error("The wall came off the helix; the state 'wound' cannot be prepared.");
  const StepInput last = pulled(2);
  one.input = [last](double end) {
    StepInput input = last;
    input.joints[Insertion] += kMorePull * part(end, kMotion);
    input.joints[Rotation] += kMoreTurn * part(end, kMotion);
    return input;
  };
  return one;
}

ContactCase ContactStates::cinch(int sets_before) const {
  ContactCase one;
  one.model = model_;
  one.urdf = urdf_;
  one.signal = ContactSignal::ThreadTension;
  one.duration = kCinch + kHold;
  SutureSession session(model_);
  session.settle();
  const auto spots = planSets(WallPlan(model_->organ, session.wall()), SetLayout());
  for (int set = 0; set < sets_before; ++set) {
    log_ << "set " << set + 1 << " of " << sets_before << " before it" << std::endl;
    session.sew(spots[static_cast<std::size_t>(set)]);
  }
  session.tag(spots[static_cast<std::size_t>(sets_before)]);
  one.start = session.state();
  const StepInput held = holdAt(one.start);
  one.input = [held](double end) {
    StepInput input = held;
    input.buttons[Cinch] = end < kCinch + 1e-6 ? 1 : 0;
    return input;
  };
  return one;
}

}  // namespace vibe::benchmarks
