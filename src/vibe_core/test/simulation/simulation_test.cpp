// Class Simulation: the same bits as step() alone, and all that it keeps beside them.
#include "vibe_core/simulation/simulation.hpp"

#include <gtest/gtest.h>

#include <cfenv>
#include <cstdio>

#include "vibe_core/program/error.hpp"
#include "vibe_core/state/state_fields.hpp"
#include "vibe_testing/scope_worlds.hpp"

namespace vibe::simulation_test {
namespace {

constexpr double kRadius = 0.05;

/// A ball with gas on a foundation; with a scope that looks in at the top.
std::shared_ptr<const Model> ball(double radius = kRadius, const std::string& tissue = "shape_matching") {
  Scene scene = test::bareScene();
  scene.tissue.model = tissue;
  scene.seed = 5;
  scene.tissue.mass_damping = 5;
  scene.foundation = FoundationScene{};
  scene.gas = GasScene{};
  scene.scope = test::scopeFromAbove(radius);
  return test::World(scene, test::plainOrgan(test::icosphere(radius, 2), 2e-3), scopeText()).model;
}

StepInput inputAt(double time) {
  StepInput input;
  input.joints[Insertion] = 0.1 * time;
  input.joints[Rotation] = time;
  input.buttons[Insufflate] = time > 0.2 ? 1 : 0;
  return input;
}

TEST(Simulation, TakesTheStepsOfTheFreeFunction) {
  const auto model = ball();
  Simulation simulation(model);
  State state = initialState(*model, 5);
  Workspace workspace(*model);
  std::vector<Event> events;
  EXPECT_EQ(firstDifference(simulation.state(), state), "");
  for (int k = 0; k < 30; ++k) {
    events.clear();
    step(*model, state, inputAt(state.time), workspace, events);
    simulation.step(inputAt(simulation.time()));
    ASSERT_EQ(firstDifference(simulation.state(), state), "") << "step " << k;
    ASSERT_EQ(simulation.events().size(), events.size());
  }
  EXPECT_EQ(simulation.hash(), hash(state));
  EXPECT_EQ(simulation.stepCount(), 30);
  EXPECT_DOUBLE_EQ(simulation.time(), 0.5);
  EXPECT_EQ(simulation.timer().cpu.all.count(), 30U);
}

TEST(Simulation, RunAsksForEveryInputAndTellsTheObserverOfEveryStep) {
  const auto model = ball();
  Simulation a(model), b(model);
  int asked = 0, told = 0;
  a.run(
      20, [&](double time) { return ++asked, inputAt(time); },
      [&](const Simulation& s) { EXPECT_EQ(s.stepCount(), ++told); });
  EXPECT_EQ(asked, 20);
  EXPECT_EQ(told, 20);
  for (int k = 0; k < 20; ++k) b.step(inputAt(b.time()));
  EXPECT_EQ(firstDifference(a.state(), b.state()), "");
}

TEST(Simulation, AnInputStaysInForce) {
  const auto model = ball();
  Simulation a(model), b(model);
  a.step(inputAt(1)), a.step(), a.step();
  for (int k = 0; k < 3; ++k) b.step(inputAt(1));
  EXPECT_EQ(firstDifference(a.state(), b.state()), "");
  EXPECT_NE(a.hash(), Simulation(model).hash());
}

TEST(Simulation, TheFirstInputHoldsTheState) {
  Simulation simulation(ball());
  const auto joints = simulation.state().joints;
  simulation.step();
  EXPECT_EQ(simulation.state().joints, joints);
  State held = simulation.state();
  held.helix_pressed = true;
  held.procedure.pressed[Cinch] = 1;
  held.joints[Rotation] = 0.25;
  simulation.replaceState(held);
  EXPECT_EQ(simulation.input().joints, held.joints);
  EXPECT_EQ(simulation.input().buttons[HelixGrab], 1);
  EXPECT_EQ(simulation.input().buttons[Cinch], 1);
  EXPECT_EQ(simulation.input().pull_particle, -1);
}

TEST(Simulation, ResetGoesBackToTheBeginning) {
  Simulation simulation(ball()), fresh(ball());
  for (int k = 0; k < 10; ++k) simulation.step(inputAt(1));
  EXPECT_GT(simulation.metrics().path_length, 0);
  simulation.reset();
  EXPECT_EQ(firstDifference(simulation.state(), fresh.state()), "");
  EXPECT_EQ(firstDifference(simulation.input(), fresh.input()), "");
  EXPECT_EQ(simulation.metrics().path_length, 0);
  EXPECT_TRUE(simulation.events().empty());
  simulation.reset(99);
  EXPECT_EQ(simulation.state().seed, 99U);
  SimulationSettings settings;
  settings.seed = 99;
  EXPECT_EQ(simulation.hash(), Simulation(ball(), settings).hash());
}

// Whatever belongs to the last step is that of no other state.
TEST(Simulation, AnotherStateHasNoLastStep) {
  Simulation simulation(ball(kRadius, "shell"));
  const auto press = [&] {
    for (int k = 0; k < 120; ++k) simulation.step(test::scopeAt(0.11));
    ASSERT_FALSE(simulation.contacts().empty()) << "negative control: there is something to forget";
    ASSERT_TRUE(simulation.toolImpedance());
    ASSERT_GT(simulation.report().iterations, 0);
    ASSERT_FALSE(simulation.report().tool_force.isZero());
  };
  const auto expectNothing = [&](const char* after) {
    EXPECT_TRUE(simulation.contacts().empty()) << after;
    EXPECT_FALSE(simulation.toolImpedance()) << after;
    EXPECT_TRUE(simulation.events().empty()) << after;
    EXPECT_EQ(simulation.report().iterations, 0) << after;
    EXPECT_TRUE(simulation.report().tool_force.isZero()) << after;
  };
  expectNothing("construction");
  simulation.warmUp();
  expectNothing("warming up");
  press();
  const State pressed = simulation.state();
  simulation.warmUp();
  EXPECT_FALSE(simulation.contacts().empty()) << "those of the last step, not of the one that was forgotten";
  simulation.replaceState(pressed);
  expectNothing("another state");
  simulation.step(test::scopeAt(0.11));
  EXPECT_FALSE(simulation.contacts().empty());
  simulation.reset();
  expectNothing("a reset");
  press();
  simulation.replaceModel(ball(kRadius, "shell"));
  expectNothing("another model");
}

TEST(Simulation, ASnapshotContinuesToTheBit) {
  const auto model = ball();
  const std::string file = ::testing::TempDir() + "vibe_simulation_test.bin";
  Simulation a(model), b(model);
  for (int k = 0; k < 10; ++k) a.step(inputAt(1));
  a.saveSnapshot(file);
  b.loadSnapshot(file);
  EXPECT_EQ(firstDifference(a.state(), b.state()), "");
  for (int k = 0; k < 10; ++k) a.step(inputAt(1)), b.step(inputAt(1));
  EXPECT_EQ(firstDifference(a.state(), b.state()), "");
  // a snapshot that cannot be loaded changes nothing
  Simulation other(ball(0.06));
  other.step(inputAt(1));
  const std::uint64_t before = other.hash();
  EXPECT_THROW(other.loadSnapshot(file), Error);
  EXPECT_EQ(other.hash(), before);
  std::remove(file.c_str());
}

TEST(Simulation, APreparedStateHasTheSameFuture) {
  const auto model = ball(kRadius, "shell");
  Simulation a(model), b(model), fresh(model);
  a.run(60, inputAt);
  const State state = a.state();
  std::shared_ptr<const void> prepared = a.prepare();
  b.run(90, inputAt);
  for (Simulation* simulation : {&b, &fresh}) {
    simulation->replaceState(state);
    simulation->step(inputAt(simulation->time()));
    EXPECT_EQ(prepared.use_count(), 2) << "it is used";
    prepared = nullptr;
    prepared = a.prepare();  // still the same: the simulation keeps what it uses
    EXPECT_EQ(prepared.use_count(), 2);
    simulation->run(40, inputAt);
    EXPECT_EQ(prepared.use_count(), 1) << "until there is another factor";
  }
  prepared = nullptr;
  Simulation without(model);
  without.replaceState(state);
  without.run(41, inputAt);
  EXPECT_EQ(b.hash(), without.hash());
  EXPECT_EQ(fresh.hash(), without.hash());
}

TEST(Simulation, AnotherModelTakesOverAtItsBeginning) {
  Simulation simulation(ball());
  for (int k = 0; k < 10; ++k) simulation.step(inputAt(1));
  const auto larger = ball(0.06);
  simulation.replaceModel(larger);
  EXPECT_EQ(simulation.sharedModel(), larger);
  Simulation fresh(larger);
  for (int k = 0; k < 10; ++k) simulation.step(inputAt(0.5)), fresh.step(inputAt(0.5));
  EXPECT_EQ(firstDifference(simulation.state(), fresh.state()), "");
  EXPECT_EQ(simulation.metrics().path_length, fresh.metrics().path_length);
}

TEST(Simulation, RecordsMetricsUnlessToldNotTo) {
  const auto model = ball();
  Simulation recorded(model), bare(model, SimulationSettings::study(5));
  for (int k = 0; k < 30; ++k) recorded.step(inputAt(1)), bare.step(inputAt(1));
  EXPECT_NEAR(recorded.metrics().insufflation_time, 0.5, 1e-9);
  EXPECT_GT(recorded.metrics().path_length, 1e-3);
  EXPECT_EQ(bare.metrics().insufflation_time, 0);
  EXPECT_EQ(bare.metrics().path_length, 0);
  EXPECT_EQ(firstDifference(recorded.state(), bare.state()), "");
}

TEST(Simulation, LoadsAShippedScene) {
  const auto model = loadModel(std::string(VIBE_CORE_DIR) + "/scenes/sphere.yaml");
  EXPECT_EQ(model->scene.name, "sphere");
  EXPECT_THROW(loadModel("package://vibe_core/scenes/no_such_scene.yaml"), Error);
}

TEST(Simulation, OfAThreadThatRoundsOtherwiseIsRefused) {
  Simulation simulation(ball());
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    std::fesetround(mode);
    EXPECT_THROW(simulation.step(), Error) << mode;
    std::fesetround(FE_TONEAREST);
  }
  EXPECT_EQ(simulation.stepCount(), 0);
  EXPECT_NO_THROW(simulation.step());
}

}  // namespace
}  // namespace vibe::simulation_test
