// Whatever a message says: it is used within the limits of the tool, or refused in one sentence.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "conversions/input_message.hpp"
#include "input/input_interpreter.hpp"
#include "input/input_queue.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_testing/scope_worlds.hpp"

namespace vibe::sim::wrong_message_test {
namespace {

constexpr std::int64_t kStep = 16'666'667, kStart = 1'000'000'000'000;

/// Draws what is right half of the time, and else what is not.
class Draw {
 public:
  explicit Draw(int seed) : random_(static_cast<unsigned>(seed)) {}
  int upTo(int most) { return std::uniform_int_distribution<int>(0, most)(random_); }
  double number() {
    constexpr double kInf = std::numeric_limits<double>::infinity();
    static constexpr std::array<double, 12> kOdd = {0,      -0.0,   NAN, kInf,  -kInf, 1e308,
                                                    -1e308, 1e-310, 86,  -4000, 90,    1.0000001};
    if (upTo(2) > 0) return std::uniform_real_distribution<double>(-0.1, 0.1)(random_);
    return kOdd[static_cast<std::size_t>(upTo(kOdd.size() - 1))];
  }
  std_msgs::Header header(std::int64_t now) {
    static const std::array<const char*, 6> kFrames = {"", "world", "scope_base", "map", "stomach", "w\xffrl'd\n"};
    std_msgs::Header header;
    header.frame_id = kFrames[static_cast<std::size_t>(upTo(kFrames.size() - 1))];
    const std::int64_t stamp = upTo(2) == 0 ? 0 : now + static_cast<std::int64_t>(upTo(2000) - 1000) * 1'000'000;
    header.stamp.fromNSec(static_cast<std::uint64_t>(stamp));
    return header;
  }

 private:
  std::mt19937 random_;
};

sensor_msgs::JointState drawJoints(Draw& draw, InputChannel channel, std::int64_t now) {
  sensor_msgs::JointState message = makeJoints({}, jointsOf(channel), 0);
  message.header = draw.header(now);
  for (double& position : message.position) position = draw.number();
  if (draw.upTo(9) == 0) message.name.clear();
  if (draw.upTo(9) == 0) message.position.pop_back();
  if (draw.upTo(9) == 0 && !message.name.empty()) message.name[0] = message.name.back();
  return message;
}

geometry_msgs::PoseStamped drawPose(Draw& draw, std::int64_t now) {
  geometry_msgs::PoseStamped message;
  message.header = draw.header(now);
  message.pose.position.x = draw.number(), message.pose.position.z = draw.number();
  message.pose.orientation.w = draw.upTo(3) > 0 ? 1 : draw.number();
  message.pose.orientation.y = draw.upTo(3) > 0 ? 0 : draw.number();
  return message;
}

geometry_msgs::TwistStamped drawTwist(Draw& draw, std::int64_t now) {
  geometry_msgs::TwistStamped message;
  message.header = draw.header(now);
  message.twist.linear.x = draw.number(), message.twist.linear.z = draw.number();
  message.twist.angular.y = draw.number();
  return message;
}

vibe_msgs::TissuePull drawPull(Draw& draw, std::int64_t now) {
  vibe_msgs::TissuePull message;
  message.header = draw.header(now);
  message.particle = draw.upTo(40) - 2;
  message.target.y = draw.number();
  return message;
}

sensor_msgs::Joy drawButtons(Draw& draw, std::int64_t now) {
  sensor_msgs::Joy message;
  message.header = draw.header(now);
  message.buttons.resize(draw.upTo(9) > 0 ? kButtonCount : 3);
  for (int& button : message.buttons) button = draw.upTo(19) > 0 ? draw.upTo(1) : -1;
  return message;
}

InputSample drawSample(Draw& draw, std::int64_t now) {
  const InputChannel channel = draw.upTo(2) > 0 ? InputChannel::Scope : InputChannel::SuturingDevice;
  switch (draw.upTo(7)) {
    case 0:
      return readJoints(drawJoints(draw, channel, now), channel, JointSource::Measured);
    case 1:
      return readJoints(drawJoints(draw, channel, now), channel, JointSource::Commanded);
    case 2:
      return readMove(drawJoints(draw, channel, now), channel);
    case 3:
      return readTipTarget(drawPose(draw, now));
    case 4:
      return readTipMove(drawPose(draw, now));
    case 5:
      return readTipVelocity(drawTwist(draw, now));
    case 6:
      return readPull(drawPull(draw, now));
    default:
      return readButtons(drawButtons(draw, now));
  }
}

void expectSentence(const std::string& text, int seed) {
  EXPECT_GT(text.size(), 20u) << seed;
  EXPECT_EQ(text.back(), '.') << seed << ": " << text;
  EXPECT_EQ(text.find('\n'), std::string::npos) << seed << ": " << text;
}

class WrongMessageTest : public testing::Test {
 protected:
  test::World world = test::scopeWorld(test::shellUnderScope(0.06), test::openBall(0.06, 1, 2e-3));
  InputQueue queue;
  InputInterpreter interpreter;
  StepInput input;
  std::int64_t now = kStart;

  const JointLimits& limit(int joint) const { return world.model->tool->limits()[static_cast<std::size_t>(joint)]; }
  std::vector<std::string> step() {
    now += kStep;
    return interpreter.interpret(queue.takeDue(now), *world.model, input);
  }
  std::vector<std::string> use(InputSample sample) {
    sample.stamp = now + 1;
    EXPECT_TRUE(queue.push(sample));
    return step();
  }
};

TEST_F(WrongMessageTest, IsUsedWithinTheLimitsOrRefusedInASentence) {
  queue.takeDue(now);
  int used = 0, refused = 0;
  for (int seed = 0; seed < 20000; ++seed) {
    Draw draw(seed);
    try {
      const InputSample sample = drawSample(draw, now);
      if (faultOf(sample.stamp, now, InputWindow::ofWallClock()).empty()) used += queue.push(sample) ? 1 : 0;
    } catch (const Error& error) {
      ++refused;
      expectSentence(error.what(), seed);
    }
    for (const std::string& sentence : step()) expectSentence(sentence, seed);
    for (int j = 0; j < kJointCount; ++j) {
      double& joint = input.joints[static_cast<std::size_t>(j)];
      ASSERT_TRUE(std::isfinite(joint)) << seed;
      joint = std::clamp(joint, limit(j).lower, limit(j).upper);  // as the hand does with joints that were asked for
    }
    ASSERT_TRUE(input.pull_target.allFinite() && input.pull_target.norm() < 1) << seed;
  }
  EXPECT_GT(used, 5000);
  EXPECT_GT(refused, 5000);
}

TEST_F(WrongMessageTest, AnotherUnitIsRefusedAndChangesNothing) {
  queue.takeDue(now);
  InputSample near;
  near.joints = {0.05, 0.1, 0.2, 0.1, 0, 0, 0};
  use(near);
  const StepInput before = input;
  InputSample far;
  for (const bool move : {false, true}) {
    far.move = move;
    far.target = ScopeTarget::TipInWorld;
    far.tip_pose.translation() << 0, 0, 86;
    ASSERT_EQ(use(far).size(), 1u);
  }
  far.move = false;
  for (const bool turn : {false, true}) {
    far.target = ScopeTarget::VelocityInBase;
    far.tip_twist.setZero();
    far.tip_twist[turn ? 3 : 0] = 10;
    const std::vector<std::string> sentences = use(far);
    ASSERT_EQ(sentences.size(), 1u);
    EXPECT_NE(sentences[0].find(turn ? "degrees" : "millimetres"), std::string::npos) << sentences[0];
  }
  InputSample pull;
  pull.channel = InputChannel::Pull;
  pull.pull_particle = 3;
  pull.pull_target << 0, 0, 40;
  ASSERT_EQ(use(pull).size(), 1u);
  EXPECT_EQ(input.joints, before.joints);
  EXPECT_EQ(input.pull_particle, -1);
  EXPECT_FALSE(interpreter.moves(InputChannel::Scope));
}

TEST_F(WrongMessageTest, DegreesGoToTheLimitAndAreNamed) {
  queue.takeDue(now);
  InputSample degrees;
  degrees.joints[Rotation] = 90;
  for (const bool move : {false, true}) {
    degrees.move = move;
    const std::vector<std::string> sentences = use(degrees);
    ASSERT_EQ(sentences.size(), 1u);
    EXPECT_NE(sentences[0].find("rotation at 90 rad, and it goes from -3.14 to 3.14"), std::string::npos)
        << sentences[0];
  }
  degrees.joints[Rotation] = limit(Rotation).upper + 0.1;
  EXPECT_TRUE(use(degrees).empty()) << "a device may end a little beyond";
}

TEST_F(WrongMessageTest, AFrameThatChangesIsNamed) {
  queue.takeDue(now);
  InputSample sample;
  sample.target = ScopeTarget::TipInWorld;
  use(sample);
  EXPECT_TRUE(use(sample).empty() || use(sample)[0].find("frame") == std::string::npos);
  sample.target = ScopeTarget::TipInBase;
  const std::vector<std::string> sentences = use(sample);
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_NE(sentences[0].find("changed its frame from 'world' to 'scope_base'"), std::string::npos);
}

}  // namespace
}  // namespace vibe::sim::wrong_message_test
