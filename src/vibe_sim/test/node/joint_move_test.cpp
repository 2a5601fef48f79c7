#include "input/input_interpreter.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "input/input_queue.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_testing/scope_fixture.hpp"

namespace vibe::sim::joint_move_test {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
const JointArray kStart = {0.02, 0.3, 0, -0.1, 0, 0, 0};
const JointArray kGoal = {0.08, -0.5, 0.4, -0.1, 9, 9, 9};

class JointMoveTest : public testing::Test {
 protected:
  ToolModel tool = loadScope();
  JointMove move{kStart, kGoal, 0, kScopeJointCount, tool.limits(), 5000};

  JointArray at(std::int64_t stamp) const {
    JointArray joints{1, 1, 1, 1, 1, 1, 1};
    move.apply(stamp, joints);
    return joints;
  }
};

TEST_F(JointMoveTest, GoesFromTheStartToTheGoalAndStaysThere) {
  for (int j = 0; j < kScopeJointCount; ++j) {
    EXPECT_EQ(at(0)[j], kStart[j]);
    EXPECT_EQ(at(5000)[j], kStart[j]);
    EXPECT_NEAR(at(move.end())[j], kGoal[j], 1e-15);
    EXPECT_NEAR(at(move.end() + 1'000'000'000)[j], kGoal[j], 1e-15);
    EXPECT_NEAR(at((5000 + move.end()) / 2)[j], 0.5 * (kStart[j] + kGoal[j]), 1e-6) << "symmetric";
  }
  for (int j = kScopeJointCount; j < kJointCount; ++j) EXPECT_EQ(at(move.end())[j], 1) << "not its joints";
}

TEST_F(JointMoveTest, OneJointMovesAtItsLimitAndNoneFaster) {
  double fastest = 0;
  for (std::int64_t stamp = 5000; stamp < move.end(); stamp += kMillisecond)
    for (int j = 0; j < kScopeJointCount; ++j) {
      const double speed = 1e3 * std::abs(at(stamp + kMillisecond)[j] - at(stamp)[j]);
      EXPECT_LE(speed, tool.limits()[j].velocity * (1 + 1e-6)) << kJointNames[j];
      fastest = std::max(fastest, speed / tool.limits()[j].velocity);
    }
  EXPECT_GT(fastest, 0.99);
}

TEST_F(JointMoveTest, AGoalBeyondTheLimitsIsClamped) {
  const JointMove far(kStart, {9, 0, 0, 0, 0, 0, 0}, 0, kScopeJointCount, tool.limits(), 0);
  JointArray joints{};
  far.apply(far.end(), joints);
  EXPECT_NEAR(joints[Insertion], tool.limits()[Insertion].upper, 1e-15);
}

TEST_F(JointMoveTest, AMoveToWhereItIsTakesNoTime) {
  const JointMove none(kStart, kStart, 0, kScopeJointCount, tool.limits(), 7);
  EXPECT_EQ(none.end(), 8) << "busy for one step";
  JointArray joints{};
  none.apply(7, joints);
  EXPECT_EQ(joints[Insertion], kStart[Insertion]);
}

class MoveQueueTest : public testing::Test {
 protected:
  InputQueue queue;
  InputInterpreter interpreter;
  Model model;
  StepInput input;

  MoveQueueTest() { model.tool = std::make_shared<ToolModel>(loadScope()); }

  void send(InputChannel channel, double position, bool move) {
    InputSample sample;
    sample.channel = channel;
    sample.joints.fill(position);
    sample.move = move;
    queue.push(sample);
  }
};

TEST_F(MoveQueueTest, BeginsWhereTheHandIsAndNotWhereItWasSentTo) {
  input.joints[Insertion] = 0.2;
  send(InputChannel::Scope, 0.1, true);
  interpreter.interpret(queue.takeDue(1000), model, input, JointArray{0.05});
  EXPECT_EQ(input.joints[Insertion], 0.05);
  EXPECT_TRUE(interpreter.moves(InputChannel::Scope));
  EXPECT_FALSE(interpreter.moves(InputChannel::SuturingDevice));
  interpreter.interpret(queue.takeDue(20'000 * kMillisecond), model, input);
  EXPECT_NEAR(input.joints[Insertion], 0.1, 1e-15);
  EXPECT_FALSE(interpreter.moves(InputChannel::Scope));
}

TEST_F(MoveQueueTest, TheScopeAndTheDeviceMoveIndependently) {
  send(InputChannel::Scope, 0.1, true);
  send(InputChannel::SuturingDevice, 0.01, true);
  interpreter.interpret(queue.takeDue(1000), model, input);
  send(InputChannel::Scope, 0.02, false);
  interpreter.interpret(queue.takeDue(2000), model, input);
  EXPECT_EQ(input.joints[Insertion], 0.02);
  EXPECT_FALSE(interpreter.moves(InputChannel::Scope));
  EXPECT_TRUE(interpreter.moves(InputChannel::SuturingDevice));
  interpreter.endMoves();
  EXPECT_FALSE(interpreter.moves(InputChannel::SuturingDevice));
}

TEST_F(MoveQueueTest, AMoveWithoutAScopeIsASentence) {
  model.tool.reset();
  send(InputChannel::SuturingDevice, 0.1, true);
  const std::vector<std::string> sentences = interpreter.interpret(queue.takeDue(1000), model, input);
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_EQ(sentences[0].rfind("suturing_device/move_jp", 0), 0u);
  EXPECT_FALSE(interpreter.moves(InputChannel::SuturingDevice));
}

}  // namespace
}  // namespace vibe::sim::joint_move_test
