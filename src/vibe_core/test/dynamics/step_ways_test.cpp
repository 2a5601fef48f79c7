// The ways on which a step goes on where something is not as foreseen, see docs/computation.md. Each is taken from a
// stored state: that before the first step of a rough session which takes it. Each promises something that the step
// lacks where the way is switched off.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/simulation/simulator.hpp"
#include "vibe_core/solver/step_policy.hpp"
#include "vibe_testing/scope_fixture.hpp"

namespace vibe::step_ways_test {
namespace {

constexpr double kOff = 1e300;

/// A state and the input of the step after it, which takes a way.
struct Moment {
  State before;
  StepInput input;
};

/// What a step made of a moment.
struct Result {
  State state;
  StepReport report;
  std::vector<Event> events;
};

Scene roughScene() {
  Scene scene = loadScene(std::string(VIBE_CORE_DIR) + "/scenes/stomach.yaml");
  scene.geometry.particles = 900;
  scene.render_surface = false;
  scene.helix->reach = 8e-3;
  return scene;
}

/// A scope that a strong hand throws from limit to limit, mostly holding the wall where it comes by.
class RoughSession {
 public:
  RoughSession()
      : model_(buildModel(roughScene(), scopeText())), workspace_(*model_), state_(initialState(*model_, 1)) {
    for (int k = 0; k < 30; ++k) step({});
    std::mt19937 generator(5);
    for (int jump = 0; jump < 40; ++jump) {
      const StepInput input = anyInput(generator);
      for (int k = 0; k < 12; ++k) {
        state_.hand_effort.fill(0);
        step(input);
      }
    }
  }

  const std::map<StepWay, Moment>& moments() const { return moments_; }
  const Model& model() const { return *model_; }

  /// In a workspace of its own, so that nothing but the state decides.
  Result stepFrom(const Moment& moment, const StepPolicy& policy = StepPolicy()) const {
    Result result{moment.before, {}, {}};
    setStepPolicy(policy);
    Workspace workspace(*model_);
    vibe::step(*model_, result.state, moment.input, workspace, result.events);
    setStepPolicy(StepPolicy());
    result.report = workspace.report();
    return result;
  }

 private:
  StepInput anyInput(std::mt19937& generator) const {
    std::uniform_real_distribution<double> uniform(0, 1);
    StepInput input;
    for (int j = 0; j < kJointCount; ++j) {
      const JointLimits& limits = model_->tool->limits()[j];
      input.joints[j] = uniform(generator) < 0.5 ? limits.lower : limits.upper;
    }
    input.joints[Insertion] = (0.5 + 0.5 * uniform(generator)) * model_->tool->limits()[Insertion].upper;
    input.buttons[HelixGrab] = uniform(generator) < 0.9 ? 1 : 0;
    return input;
  }

  void step(const StepInput& input) {
    const State before = state_;
    vibe::step(*model_, state_, input, workspace_, events_);
    for (std::size_t k = 0; k < kStepWayCount; ++k)
      if (workspace_.report().ways.of(static_cast<StepWay>(k)) > 0)
        moments_.try_emplace(static_cast<StepWay>(k), Moment{before, input});
  }

  std::shared_ptr<const Model> model_;
  Workspace workspace_;
  State state_;
  std::vector<Event> events_;
  std::map<StepWay, Moment> moments_;
};

/// Made once for all tests.
const RoughSession& session() {
  static const RoughSession rough;
  return rough;
}

/// The moment of a way, taken again: what decides on the ways is in the state and the input.
Moment momentOf(StepWay way) {
  const auto found = session().moments().find(way);
  EXPECT_NE(found, session().moments().end()) << nameOf(way) << " is not taken in the session";
  if (found == session().moments().end()) return {};
  EXPECT_GT(session().stepFrom(found->second).report.ways.of(way), 0) << nameOf(way) << " is not taken again";
  return found->second;
}

double farthestApart(const State& a, const State& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.x.size(); ++i)
    most = std::max(most, std::hypot(a.x[i] - b.x[i], a.y[i] - b.y[i], a.z[i] - b.z[i]));
  return most;
}

bool hasNoAcceleration(const State& state) {
  for (const auto* a : {&state.ax, &state.ay, &state.az})
    if (std::any_of(a->begin(), a->end(), [](double value) { return value != 0; })) return false;
  return true;
}

TEST(StepWays, TheSessionTakesTheseWays) {
  for (const auto& [way, moment] : session().moments()) RecordProperty(nameOf(way), 1);
  for (const auto& [way, moment] : session().moments())
    std::printf("%s: step %ld\n", nameOf(way), long(moment.before.step));
}

}  // namespace
}  // namespace vibe::step_ways_test
