// From the arrival of its inputs to its state, a step takes no lock, and asks for no memory once a session has settled
// in. The measures of skill, which follow, and messages in roscpp do ask for memory.
#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>
#include <thread>

#include "input/input_interpreter.hpp"
#include "input/input_queue.hpp"
#include "vibe_core/simulation/simulation.hpp"
#include "vibe_testing/allocation_count.hpp"
#include "vibe_testing/lock_count.hpp"
#include "vibe_testing/scope_worlds.hpp"

namespace vibe::sim::step_path_test {
namespace {

constexpr double kRadius = 0.06;
constexpr int kCycle = 60;                    // steps
constexpr std::int64_t kPeriod = 10'000'000;  // of the steps [ns]

struct Count {
  long allocations = 0, locks = 0;
};

template <class Work>
Count countsOf(Work work) {
  const long allocations = test::allocations, locks = test::locks;
  work();
  return {test::allocations - allocations, test::locks - locks};
}

// A stomach in small, with a hand that holds its wall with the helix, draws it to the tip and lets it go again.
class StepPath : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!VIBE_COUNTS_ALLOCATIONS || !VIBE_COUNTS_LOCKS) GTEST_SKIP() << "a sanitizer brings functions of its own";
  }

  StepPath() : simulation(makeModel(), SimulationSettings::study(1)) { simulation.warmUp(); }

  static std::shared_ptr<const Model> makeModel() {
    Scene scene;
    scene.step_period = 1e-9 * kPeriod;
    scene.tissue.model = "shell";
    scene.tissue.self_contact = true;
    scene.foundation = FoundationScene{};
    scene.gas = GasScene{};
    scene.gas->initial_pressure = 800;
    scene.scope = test::scopeFromAbove(kRadius);
    scene.helix = test::wideHelix();
    return test::scopeWorld(scene, test::openBall(kRadius, 4, 2.3e-3)).model;
  }

  void send(InputChannel channel, double part, bool grabs) {
    InputSample sample;
    sample.channel = channel;
    sample.stamp = stamp + kPeriod;
    sample.joints[Insertion] = 0.1 + 0.04 * part;
    sample.joints[HelixAdvance] = 0.028 * (1 - part);
    sample.buttons[HelixGrab] = grabs ? 1 : 0;
    EXPECT_TRUE(queue.push(sample));
  }

  void sendAll(double part, bool grabs) {
    for (const InputChannel channel : {InputChannel::Scope, InputChannel::SuturingDevice, InputChannel::Buttons})
      send(channel, part, grabs);
  }

  // What SimulationThread::takeStep() does up to the state.
  void step() {
    stamp += kPeriod;
    StepInput input = simulation.input();
    const DueInput& due = queue.takeDue(stamp);
    interpreter.interpret(due, simulation.model(), input, simulation.state().joints);
    releaseSilentButtons(due, input);
    simulation.setInput(input);
    simulation.step();
  }

  Count countedStep(double part, bool grabs) {
    sendAll(part, grabs);
    return countsOf([this] { step(); });
  }

  double partAt(int i) const { return 0.5 * (1 - std::cos(2 * M_PI * i / kCycle)); }

  InputQueue queue;
  InputInterpreter interpreter;
  Simulation simulation;
  std::int64_t stamp = 1'000'000'000;
};

TEST_F(StepPath, CountsBoth) {
  std::mutex mutex;
  const Count count = countsOf([&] {
    const std::lock_guard<std::mutex> lock(mutex);
    const std::vector<double> made(7);
  });
  EXPECT_EQ(count.allocations, 1);
  EXPECT_EQ(count.locks, 1);
}

TEST_F(StepPath, ArrivalTakesNeither) {
  const Count count = countsOf([&] { sendAll(0.5, true); });
  EXPECT_EQ(count.allocations, 0);
  EXPECT_EQ(count.locks, 0);
  const Count taken = countsOf([&] { queue.collect(); });
  EXPECT_EQ(taken.allocations, 0);
  EXPECT_EQ(taken.locks, 0);
}

TEST_F(StepPath, SettledStepsTakeNeither) {
  for (int i = 0; i < 150; ++i) countedStep(0, false);
  for (int i = 0; i < 2 * kCycle; ++i) countedStep(partAt(i), true);
  ASSERT_GT(simulation.state().grip.size(), 5u);

  // in motion the number of contacts changes, and matrices with it
  std::vector<long> allocations;
  int touching = 0;
  for (int i = 0; i < kCycle; ++i) {
    const Count count = countedStep(partAt(i), true);
    EXPECT_EQ(count.locks, 0) << "in motion, step " << i;
    allocations.push_back(count.allocations);
    touching += simulation.state().contact_count > 0 ? 1 : 0;
  }
  EXPECT_GT(touching, 5);
  std::sort(allocations.begin(), allocations.end());
  EXPECT_EQ(allocations[allocations.size() / 2], 0);
  EXPECT_LT(allocations.back(), 50);

  for (int i = 0; i < 2 * kCycle; ++i) countedStep(partAt(kCycle / 2), true);
  for (int i = 0; i < kCycle; ++i) {
    const Count count = countedStep(partAt(kCycle / 2), true);
    EXPECT_EQ(count.allocations, 0) << "held still, step " << i;
    EXPECT_EQ(count.locks, 0) << "held still, step " << i;
  }
}

TEST_F(StepPath, SamplesOfAnotherThreadAllArrive) {
  constexpr int kCount = 20000;
  std::thread hand([this] {
    for (int i = 1; i <= kCount; ++i) {
      InputSample sample;
      sample.joints[Insertion] = 1e-6 * i;
      sample.stamp = i;
      while (!queue.push(sample)) std::this_thread::yield();
    }
  });
  StepInput input;
  double last = 0;
  for (std::int64_t now = 0; last < 1e-6 * kCount - 1e-9; now += 7) {
    interpreter.interpret(queue.takeDue(now), simulation.model(), input);
    ASSERT_GE(input.joints[Insertion], last);
    last = input.joints[Insertion];
  }
  hand.join();
  EXPECT_DOUBLE_EQ(last, 1e-6 * kCount);
}

}  // namespace
}  // namespace vibe::sim::step_path_test
