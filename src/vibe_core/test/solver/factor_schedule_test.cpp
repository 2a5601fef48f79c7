// When a factor is renewed is decided by the state alone, and which one is used by its name.
#include "solver/stepper_workspace.hpp"

#include <gtest/gtest.h>

#include "solver/implicit_worlds.hpp"
#include "sparse/factor_plan.hpp"

namespace vibe::factor_schedule_test {
namespace {

using namespace test;

constexpr FactorSchedule kSchedule{3600, 1, 3, 1e-3};

struct Fixture {
  Fixture() : body(cantilever({3, 1, 1})), stepper(body, {}), motion(body), scratch(stepper.makeWorkspace()) {}
  void moveTip(double by) { motion.x[2].back() = body.rest.back().z() + by; }
  void advance(const FactorSchedule& schedule = kSchedule) {
    schedule.advance(body, motion.view(), loads, memory, scratch->factors);
  }
  void step() {
    advance();
    kSchedule.provide(body, {}, memory, scratch->factors, scratch->single);
    ++memory.steps;
  }
  std::vector<float> solution(const StepperWorkspace& of) const {
    std::vector<float> nodes4(4 * body.rest.size(), 1.0F), half(of.iterate.half.size(), 0.0F);
    of.factors.current->load(nodes4.data(), half.data());
    of.factors.current->forward(half.data());
    of.factors.current->backward(half.data());
    of.factors.current->store(half.data(), nodes4.data());
    return nodes4;
  }
  ElasticBody body;
  ImplicitStepper stepper;
  BodyMotion motion;
  BodyLoads loads;
  StepperMemory memory;
  std::shared_ptr<StepperWorkspace> scratch;
};

TEST(FactorSchedule, TissueThatStaysNeedsNoOtherFactor) {
  Fixture fixture;
  fixture.moveTip(0.9e-3);
  for (int i = 0; i < 10; ++i) fixture.step();
  EXPECT_TRUE(fixture.memory.next.empty());
  EXPECT_TRUE(fixture.memory.linearization_point.empty()) << "still the factor about rest";
  EXPECT_NE(fixture.memory.linearization_id, 0u);
}

TEST(FactorSchedule, PositionsAreNamedWhenANodeIsFarAndTakeOverAfterTheGivenSteps) {
  Fixture fixture;
  fixture.step();
  const std::uint64_t rest = fixture.memory.linearization_id;
  fixture.moveTip(1.1e-3);
  fixture.step();
  ASSERT_FALSE(fixture.memory.next.empty());
  EXPECT_EQ(fixture.memory.due, 1 + kSchedule.steps);
  const std::uint64_t next = fixture.memory.next_id;
  EXPECT_NE(next, rest);
  fixture.moveTip(5e-3);  // later motion does not change what was named
  for (int i = 0; i < kSchedule.steps - 1; ++i) {
    fixture.step();
    EXPECT_EQ(fixture.memory.linearization_id, rest) << "step " << i;
    EXPECT_EQ(fixture.scratch->factors.current_id, rest);
  }
  fixture.step();
  EXPECT_EQ(fixture.memory.linearization_id, next);
  EXPECT_EQ(fixture.scratch->factors.current_id, next);
  EXPECT_FLOAT_EQ(fixture.memory.linearization_point.back(), static_cast<float>(fixture.body.rest.back().z() + 1.1e-3));
}

// The number of operations of the plan decides, and no clock.
TEST(FactorSchedule, AFactorThatTakesMoreOperationsTakesOverLater) {
  Fixture fixture;
  const double operations =
      makeFactorPlan(blockPattern(fixture.body.nodeCount(), fixture.body.elements->nodeGroups()))->operations;
  fixture.moveTip(1.1e-3);
  for (const auto& [seconds, steps] : {std::pair(0.01, 6), std::pair(0.5, 30)}) {
    StepSettings settings;
    settings.factor_rate = operations / seconds;
    const ImplicitStepper stepper(fixture.body, settings);
    BodyMotion motion = fixture.motion;
    StepperMemory memory;
    const auto scratch = stepper.makeWorkspace();
    stepper.step(motion.view(), fixture.loads, memory, *scratch);
    EXPECT_EQ(memory.due, steps);
  }
}

TEST(FactorSchedule, EqualPositionsHaveEqualNames) {
  Fixture a, b, c;
  for (Fixture* fixture : {&a, &b}) fixture->moveTip(2e-3);
  c.moveTip(2.001e-3);
  for (Fixture* fixture : {&a, &b, &c})
    FactorSchedule::nameHere(fixture->body, fixture->motion.view(), fixture->memory);
  EXPECT_EQ(a.memory.linearization_id, b.memory.linearization_id);
  EXPECT_NE(a.memory.linearization_id, c.memory.linearization_id);
}

TEST(FactorSchedule, AnIntervalOfZeroKeepsTheFactor) {
  Fixture fixture;
  FactorSchedule schedule = kSchedule;
  schedule.steps = 0;
  fixture.moveTip(0.1);
  for (int i = 0; i < 10; ++i, ++fixture.memory.steps) fixture.advance(schedule);
  EXPECT_TRUE(fixture.memory.next.empty());
}

TEST(FactorSchedule, APositionThatIsNotFiniteCountsAsFar) {
  Fixture fixture;
  fixture.moveTip(std::nan(""));
  fixture.advance();
  EXPECT_FALSE(fixture.memory.next.empty());
}

// A replay has no factor in the background, a session has: both must have the same bits.
TEST(FactorSchedule, AFactorFromTheBackgroundHasTheBitsOfOneMadeAtOnce) {
  Fixture fixture;
  fixture.step();
  const std::vector<float> about_rest = fixture.solution(*fixture.scratch);
  fixture.moveTip(4e-3);
  for (int i = 0; i < 1 + kSchedule.steps; ++i) fixture.step();
  const std::vector<float> from_background = fixture.solution(*fixture.scratch);
  EXPECT_NE(from_background, about_rest) << "negative control: the factor has not changed";
  const auto fresh = fixture.stepper.makeWorkspace();
  StepperMemory memory = fixture.memory;
  memory.next.clear();
  kSchedule.provide(fixture.body, {}, memory, fresh->factors, fresh->single);
  EXPECT_EQ(fixture.solution(*fresh), from_background);
}

TEST(FactorSchedule, AttachmentColumnsFollowTheirFactor) {
  Fixture fixture;
  BodyLoads loads;
  loads.attachments = {{{4, 5}, {0.5, 0.5}}};
  fixture.advance();
  kSchedule.provide(fixture.body, loads, fixture.memory, fixture.scratch->factors, fixture.scratch->single);
  const ColumnCache& columns = fixture.scratch->factors.columns;
  const std::vector<float> first = columns.columns(columns.attachmentSlot(0)).value;
  loads.attachments.push_back({{7}, {1}});
  kSchedule.provide(fixture.body, loads, fixture.memory, fixture.scratch->factors, fixture.scratch->single);
  EXPECT_EQ(columns.columns(columns.attachmentSlot(0)).value, first);
  EXPECT_FALSE(columns.columns(columns.attachmentSlot(1)).value.empty());
  loads.attachments = {{{7}, {1}}};
  kSchedule.provide(fixture.body, loads, fixture.memory, fixture.scratch->factors, fixture.scratch->single);
  EXPECT_NE(columns.columns(columns.attachmentSlot(0)).value, first);
}

}  // namespace
}  // namespace vibe::factor_schedule_test
