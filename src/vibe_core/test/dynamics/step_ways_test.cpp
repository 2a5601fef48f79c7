// The ways on which a step goes on where something is not as foreseen, see docs/computation.md. Each is taken from a
// stored state: that before the first step of a rough session which takes it. Each promises something that the step
// lacks where the way is switched off.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <stdexcept>

#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/simulation/simulator.hpp"
#include "vibe_core/solver/step_policy.hpp"
#include "vibe_testing/scope_fixture.hpp"
#include "vibe_testing/tool_crossings.hpp"

namespace vibe::step_ways_test {
namespace {

constexpr double kOff = 1e300;
constexpr std::size_t kKept = 8;  // moments of each way
constexpr int kMostSeeds = 12;

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

/// A scope that a strong hand first leads to where it presses the wall, and then throws from limit to limit, mostly
/// holding the wall where it comes by. Which ways that takes depends on the last bit: it goes on until each of those
/// that a tool brings about has been taken.
class RoughSession {
 public:
  RoughSession() : model_(buildModel(roughScene(), scopeText())), workspace_(*model_) {
    for (int seed = 1; seed <= kMostSeeds && !isComplete(); ++seed) run(seed);
  }

  /// The first of each way.
  const std::map<StepWay, std::vector<Moment>>& moments() const { return moments_; }
  const Model& model() const { return *model_; }

  /// In a workspace of its own, so that nothing but the state decides.
  Result stepFrom(const Moment& moment, const StepPolicy& policy = StepPolicy()) const {
    Result result{moment.before, {}, {}};
    const ScopedStepPolicy scoped(policy);
    Workspace workspace(*model_);
    vibe::step(*model_, result.state, moment.input, workspace, result.events);
    result.report = workspace.report();
    return result;
  }

 private:
  bool isComplete() const {
    constexpr std::array kOfTools{StepWay::GuessMisled,   StepWay::ContactsExchanged, StepWay::ToolReaimedEarly,
                                  StepWay::PairsDropped,  StepWay::LastMoveUnseen,    StepWay::NotArrived,
                                  StepWay::BackwardEuler, StepWay::ToolReaimed,       StepWay::ToolLimited};
    return std::all_of(kOfTools.begin(), kOfTools.end(), [&](StepWay way) { return moments_.count(way) > 0; });
  }

  void run(int seed) {
    std::mt19937 generator(seed);
    state_ = initialState(*model_, 1);
    for (int k = 0; k < 30; ++k) step({});
    for (int goal = 0; goal < 6; ++goal) press(generator);
    for (int jump = 0; jump < 40; ++jump) {
      const StepInput input = anyInput(generator);
      for (int k = 0; k < 12; ++k) {
        state_.hand_effort.fill(0);
        step(input);
      }
    }
  }

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

  void press(std::mt19937& generator) {
    std::uniform_real_distribution<double> uniform(0, 1);
    const std::array<double, kJointCount> from = state_.joints;
    std::array<double, kJointCount> goal;
    for (int j = 0; j < kJointCount; ++j) {
      const JointLimits& limits = model_->tool->limits()[j];
      goal[j] = limits.lower + uniform(generator) * (limits.upper - limits.lower);
    }
    goal[Insertion] = (0.4 + 0.5 * uniform(generator)) * model_->tool->limits()[Insertion].upper;
    for (int k = 1; k <= 40; ++k) {
      StepInput input;
      for (int j = 0; j < kJointCount; ++j) input.joints[j] = from[j] + k / 40.0 * (goal[j] - from[j]);
      step(input);
    }
  }

  void step(const StepInput& input) {
    const State before = state_;
    vibe::step(*model_, state_, input, workspace_, events_);
    for (std::size_t k = 0; k < kStepWayCount; ++k)
      if (workspace_.report().ways.of(static_cast<StepWay>(k)) > 0) {
        std::vector<Moment>& moments = moments_[static_cast<StepWay>(k)];
        if (moments.size() < kKept) moments.push_back({before, input});
      }
  }

  std::shared_ptr<const Model> model_;
  Workspace workspace_;
  State state_;
  std::vector<Event> events_;
  std::map<StepWay, std::vector<Moment>> moments_;
};

/// Made once for all tests.
const RoughSession& session() {
  static const RoughSession rough;
  return rough;
}

/// The first moments of a way.
const std::vector<Moment>& momentsOf(StepWay way) {
  const auto found = session().moments().find(way);
  if (found == session().moments().end()) throw std::runtime_error(std::string(nameOf(way)) + " is not taken");
  return found->second;
}

Moment momentOf(StepWay way) {
  return momentsOf(way).front();
}

double farthestApart(const State& a, const State& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.x.size(); ++i)
    most = std::max(most, std::hypot(a.x[i] - b.x[i], a.y[i] - b.y[i], a.z[i] - b.z[i]));
  return most;
}

/// Triangles of the wall through which the core of a shape of the tool passes.
int piercedBy(const Model& model, const State& state) {
  std::vector<Eigen::Isometry3d> poses;
  model.tool->forwardKinematics(state.joints, state.tool_displacement, poses);
  for (Eigen::Isometry3d& pose : poses) pose = model.tool_base * pose;
  std::vector<char> passes;
  for (const End end : model.organ.end) passes.push_back(end != End::None ? 1 : 0);
  const SurfaceView view{model.organ.surface.triangles, state.x, state.y, state.z};
  return test::findToolCrossing(*model.tool, poses, view, passes).pierced;
}

bool hasNoAcceleration(const State& state) {
  for (const auto* a : {&state.ax, &state.ay, &state.az})
    if (std::any_of(a->begin(), a->end(), [](double value) { return value != 0; })) return false;
  return true;
}

TEST(StepWays, AMomentIsWhollyInTheStateAndTheInput) {
  for (const auto& [way, moments] : session().moments()) {
    const Moment& moment = moments.front();
    const Result one = session().stepFrom(moment), other = session().stepFrom(moment);
    EXPECT_GT(one.report.ways.of(way), 0) << nameOf(way) << " is not taken again";
    EXPECT_EQ(hash(one.state), hash(other.state)) << nameOf(way);
  }
}

// A guess along the velocities would leave the wall on the wrong side of what it has met, with more energy.
TEST(StepWays, AGuessThatMisleadsIsGivenUp) {
  StepPolicy keeps;
  keeps.misled_part = kOff;
  int better = 0, worse = 0;
  for (const Moment& moment : momentsOf(StepWay::GuessMisled)) {
    const Result given_up = session().stepFrom(moment), kept = session().stepFrom(moment, keeps);
    EXPECT_EQ(kept.report.ways.of(StepWay::GuessMisled), 0);
    ++(given_up.state.solver.elastic_energy < kept.state.solver.elastic_energy ? better : worse);
  }
  EXPECT_GT(better, worse);
}

// A contact without a row pushes with no force, so the wall would go through the tool there: what a step leaves is in
// its residual.
TEST(StepWays, ContactsThatWouldBeDeepInTheToolGetRows) {
  StepPolicy keeps;
  keeps.contact_exchanges = 0;
  int better = 0, worse = 0;
  for (const Moment& moment : momentsOf(StepWay::ContactsExchanged)) {
    const Result exchanged = session().stepFrom(moment), kept = session().stepFrom(moment, keeps);
    EXPECT_EQ(kept.report.ways.of(StepWay::ContactsExchanged), 0);
    ++(exchanged.report.residual < kept.report.residual ? better : worse);
  }
  EXPECT_GT(better, worse);
}

TEST(StepWays, AToolThatIsLedElsewhereIsAimedAgainBeforeAnythingMoves) {
  const Moment moment = momentOf(StepWay::ToolReaimedEarly);
  StepPolicy never;
  never.miss_speed = kOff;
  const Result aimed = session().stepFrom(moment), missed = session().stepFrom(moment, never);
  EXPECT_EQ(missed.report.ways.of(StepWay::ToolReaimedEarly), 0);
  EXPECT_EQ(aimed.report.solves, 1 + aimed.report.ways.of(StepWay::ToolLimited)) << "the first direction is no solve";
  EXPECT_NE(aimed.state.tool_displacement, missed.state.tool_displacement);
}

// From the end of the first solve, the second is short.
TEST(StepWays, AToolThatASolveLeadsElsewhereIsAimedAgain) {
  StepPolicy never;
  never.miss_speed = kOff;
  for (const Moment& moment : momentsOf(StepWay::ToolReaimed)) {
    const Result aimed = session().stepFrom(moment), missed = session().stepFrom(moment, never);
    EXPECT_EQ(missed.report.ways.of(StepWay::ToolReaimed), 0);
    EXPECT_GE(aimed.report.solves, 2);
    EXPECT_LT(aimed.report.evaluations, 2 * missed.report.evaluations + 8);
    EXPECT_NE(aimed.state.tool_displacement, missed.state.tool_displacement);
  }
}

// Along a direction that leads up no search gets on, so that the step would not arrive.
TEST(StepWays, ADirectionThatLeadsUpLosesItsHistory) {
  int arrived = 0, not_arrived = 0;
  for (const Moment& moment : momentsOf(StepWay::PairsDropped))
    ++(session().stepFrom(moment).report.arrived ? arrived : not_arrived);
  EXPECT_GT(arrived, not_arrived);
}

// What is not looked at is a hundredth of what was moved.
TEST(StepWays, AMoveThatIsNotEvaluatedLeavesLittle) {
  const Moment moment = momentOf(StepWay::LastMoveUnseen);
  StepPolicy looks;
  looks.rest_part = 0;
  looks.usual_growth = 0;
  const Result unseen = session().stepFrom(moment), seen = session().stepFrom(moment, looks);
  EXPECT_LT(unseen.report.evaluations, seen.report.evaluations);
  EXPECT_LT(farthestApart(unseen.state, seen.state), 0.05 * farthestApart(moment.before, seen.state) + 1e-6);
}

TEST(StepWays, AStepThatDoesNotArriveEndsWithItsMeanVelocity) {
  const Moment moment = momentOf(StepWay::NotArrived);
  const Result result = session().stepFrom(moment);
  EXPECT_FALSE(result.report.arrived);
  EXPECT_TRUE(hasNoAcceleration(result.state));
  EXPECT_EQ(result.state.solver.backward_euler_steps, StepPolicy().fallback_steps);
  StepPolicy once;
  once.fallback_steps = 0;
  EXPECT_EQ(session().stepFrom(moment, once).state.solver.backward_euler_steps, 0);
}

TEST(StepWays, StepsAfterItTakeBackwardEuler) {
  const Moment moment = momentOf(StepWay::BackwardEuler);
  const Result result = session().stepFrom(moment);
  EXPECT_GT(moment.before.solver.backward_euler_steps, 0);
  EXPECT_TRUE(result.report.fallback);
  Moment without = moment;
  without.before.solver.backward_euler_steps = 0;
  EXPECT_EQ(session().stepFrom(without).report.ways.of(StepWay::BackwardEuler), 0);
}

TEST(StepWays, AToolThatTheWallStopsIsSolvedForWhereItCanGo) {
  const Moment moment = momentOf(StepWay::ToolLimited);
  const Result result = session().stepFrom(moment);
  EXPECT_GE(result.report.solves, 2);
  EXPECT_EQ(piercedBy(session().model(), result.state), 0);
}

/// The wall is thrown at a tool that it has stopped.
Moment thrownAtTheTool() {
  for (Moment moment : momentsOf(StepWay::ToolLimited))
    for (const double speed : {1.0, -1.0, 4.0, -4.0})
      for (auto* velocity : {&moment.before.vx, &moment.before.vy, &moment.before.vz}) {
        const std::vector<double> before = *velocity;
        for (double& v : *velocity) v += speed;
        if (session().stepFrom(moment).report.ways.of(StepWay::WallStopped) > 0) return moment;
        *velocity = before;
      }
  throw std::runtime_error("no wall is stopped");
}

TEST(StepWays, AWallThatWouldRunIntoTheToolStopsOnItsWay) {
  const Moment moment = thrownAtTheTool();
  const Result result = session().stepFrom(moment);
  const double dt = session().model().scene.step_period;
  EXPECT_EQ(result.report.ways.of(StepWay::ToolLimited), 1);
  EXPECT_TRUE(hasNoAcceleration(result.state));
  EXPECT_EQ(piercedBy(session().model(), result.state), 0);
  const State &to = result.state, &from = moment.before;
  for (std::size_t i = 0; i < to.x.size(); ++i) ASSERT_NEAR(to.vx[i] * dt, to.x[i] - from.x[i], 1e-12) << i;
}

/// A stomach that stands, with an input that does nothing.
Moment standing() {
  return {initialState(session().model(), 1), {}};
}

TEST(StepWays, TissueThatRestsSleeps) {
  Moment moment = standing();
  moment.before.solver.rest_steps = StepPolicy().rest_steps;
  moment.before.step = 1;  // one in thirty looks whether something wakes it
  const Result asleep = session().stepFrom(moment);
  EXPECT_EQ(asleep.report.evaluations, 0);
  EXPECT_EQ(farthestApart(asleep.state, moment.before), 0);
  Moment awake = moment;
  awake.before.solver.rest_steps = 0;
  const Result computed = session().stepFrom(awake);
  EXPECT_EQ(computed.report.ways.of(StepWay::Asleep), 0);
  EXPECT_GT(computed.report.evaluations, 0);
}

TEST(StepWays, AnOrganThatIsInsideOutIsLedToRest) {
  Moment moment = standing();
  State& state = moment.before;
  for (auto* axis : {&state.x, &state.y, &state.z})
    for (double& value : *axis) value = -value;
  const Result result = session().stepFrom(moment);
  EXPECT_EQ(result.report.ways.of(StepWay::Recovery), 1);
  EXPECT_TRUE(result.report.put_back);
  const State rest = initialState(session().model(), 1);
  EXPECT_LT(farthestApart(result.state, rest), 0.75 * farthestApart(state, rest));
}

TEST(StepWays, NumbersThatAreNotFiniteStartAgainFromRest) {
  Moment moment = standing();
  moment.before.vx[7] = std::nan("");
  const Result result = session().stepFrom(moment);
  EXPECT_EQ(result.report.ways.of(StepWay::NotFinite), 1);
  EXPECT_EQ(farthestApart(result.state, initialState(session().model(), 1)), 0);
  EXPECT_TRUE(std::any_of(result.events.begin(), result.events.end(),
                          [](const Event& event) { return event.kind == Event::Kind::Recovery; }));
}

}  // namespace
}  // namespace vibe::step_ways_test
