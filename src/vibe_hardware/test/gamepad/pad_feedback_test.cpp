#include "vibe_hardware/gamepad/pad_feedback.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "gamepad/evdev_pad.hpp"
#include "gamepad/pads.hpp"

namespace vibe::hardware::pad_feedback_test {
namespace {

class TestMotors : public PadMotors {
 public:
  int rumbles = 0, springs = 0;
  double strong = 0, weak = 0;
  std::array<StickSpring, 2> last{};

  bool hasRumble() const override { return true; }
  bool hasSpring() const override { return true; }
  bool rumble(double s, double w) override {
    ++rumbles;
    strong = s;
    weak = w;
    return true;
  }
  bool spring(const std::array<StickSpring, 2>& s) override {
    ++springs;
    last = s;
    return true;
  }
};

PadMapping stickMapping() {
  return mappingOf(
      "joints:\n"
      "  insertion: {axis: ABS_Y, mode: position, range: [0 cm, 20 cm], full_effort: 10 N}\n"
      "  rotation: {axis: ABS_X, mode: position, range: [-1, 1], full_effort: 0.5 N*m, reversed: true}\n"
      "feedback: {rumble_force: 4 N}\n");
}

JointSprings springsAt(double insertion_stiffness, double insertion_equilibrium) {
  JointSprings springs;
  springs.touching = true;
  springs.stiffness = {insertion_stiffness, 0.25, 0, 0};
  springs.equilibrium = {insertion_equilibrium, 0.5, 0, 0};
  return springs;
}

TEST(PadFeedback, StrongMotorFollowsTheForceUpToItsGreatest) {
  PadFeedback feedback(stickMapping());
  feedback.setForce(1, 1);
  EXPECT_DOUBLE_EQ(feedback.strongLevel(1), 0.25);
  feedback.setForce(1, -2);
  EXPECT_DOUBLE_EQ(feedback.strongLevel(1), 0.5);
  feedback.setForce(1, 100);
  EXPECT_DOUBLE_EQ(feedback.strongLevel(1), 1);
  feedback.setForce(1, std::numeric_limits<double>::quiet_NaN());
  EXPECT_DOUBLE_EQ(feedback.strongLevel(1), 1);
}

TEST(PadFeedback, StopsWhenMessagesStop) {
  PadFeedback feedback(stickMapping());
  TestMotors motors;
  feedback.setForce(0, 4);
  feedback.setSprings(0, springsAt(50, 0.05));
  double now = 0;
  const auto runTo = [&](double end) {
    for (; now < end; now += 0.005) feedback.update(now, motors);
  };
  runTo(0.05);
  EXPECT_EQ(motors.strong, 1);
  EXPECT_GT(motors.last[1].coefficient, 0.4);
  runTo(0.15);
  EXPECT_NEAR(motors.last[1].coefficient, 0.25, 0.12);  // fades
  runTo(0.23);
  EXPECT_EQ(motors.last[1].coefficient, 0);
  EXPECT_EQ(motors.strong, 1);
  runTo(0.3);
  EXPECT_EQ(motors.strong, 0);
}

TEST(PadFeedback, SendsAtMostFiftyTimesASecondAndOnlyChanges) {
  PadFeedback feedback(stickMapping());
  TestMotors motors;
  for (int k = 0; k < 1000; ++k) {
    const double now = 0.001 * k;
    feedback.setForce(now, 2 + std::sin(50 * now));
    feedback.setSprings(now, springsAt(20 + 10 * std::sin(50 * now), 0.05));
    feedback.update(now, motors);
  }
  EXPECT_LE(motors.rumbles, 51);
  EXPECT_GE(motors.rumbles, 30);
  EXPECT_LE(motors.springs, 51);
  TestMotors still;
  PadFeedback constant(stickMapping());
  for (int k = 0; k < 1000; ++k) {
    constant.setForce(0.001 * k, 2);
    constant.update(0.001 * k, still);
  }
  EXPECT_LE(still.rumbles, 5);  // once, and again before the kernel's effect ends
  EXPECT_GE(still.rumbles, 3);
  EXPECT_EQ(still.springs, 0);
}

TEST(PadFeedback, PulsesEndAndTheStrongerOneWins) {
  PadFeedback feedback(stickMapping());
  feedback.pulse(0, PadPulse::Bite);
  feedback.pulse(0.01, PadPulse::Contact);
  EXPECT_DOUBLE_EQ(feedback.weakLevel(0.05), 1);
  EXPECT_DOUBLE_EQ(feedback.weakLevel(0.31), 0);
  feedback.pulse(1, PadPulse::Contact);
  EXPECT_DOUBLE_EQ(feedback.weakLevel(1.01), 0.4);
  EXPECT_DOUBLE_EQ(feedback.weakLevel(1.09), 0);
}

TEST(PadFeedback, RumbleForceZeroSwitchesRumbleOff) {
  PadMapping mapping = stickMapping();
  mapping.feedback.rumble_force = 0;
  PadFeedback feedback(mapping);
  feedback.setForce(0, 100);
  feedback.pulse(0, PadPulse::Failure);
  EXPECT_EQ(feedback.strongLevel(0), 0);
  EXPECT_EQ(feedback.weakLevel(0), 0);
}

TEST(PadFeedback, SpringPullsTheStickWhereTheTissuePullsTheJoint) {
  PadFeedback feedback(stickMapping());
  feedback.setSprings(0, springsAt(50, 0.15));
  const std::array<StickSpring, 2> springs = feedback.springs(0);
  // half of the axis is 10 cm: 5 N of 10 N; 15 cm is half way from the middle to the end
  EXPECT_NEAR(springs[1].coefficient, 0.5, 1e-12);
  EXPECT_NEAR(springs[1].centre, 0.5, 1e-12);
  // rotation is reversed; 0.25 N m of 0.5 N m at 1 rad
  EXPECT_NEAR(springs[0].coefficient, 0.5, 1e-12);
  EXPECT_NEAR(springs[0].centre, -0.5, 1e-12);
}

TEST(PadFeedback, SpringIsLimitedAndRefusesWhatIsNotFinite) {
  PadFeedback feedback(stickMapping());
  feedback.setSprings(0, springsAt(1e9, 5));
  EXPECT_EQ(feedback.springs(0)[1].coefficient, 1);
  EXPECT_EQ(feedback.springs(0)[1].centre, 1);
  feedback.setSprings(0, springsAt(std::numeric_limits<double>::infinity(), 0.1));
  feedback.setSprings(0, springsAt(50, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_EQ(feedback.springs(0)[1].coefficient, 1);  // as before
  JointSprings free;
  feedback.setSprings(0, free);
  EXPECT_EQ(feedback.springs(0)[1].coefficient, 0);
}

TEST(PadFeedback, ReturningPadIsToldAnew) {
  PadFeedback feedback(stickMapping());
  TestMotors motors;
  feedback.setForce(0, 4);
  feedback.update(0, motors);
  feedback.forgetPad();
  TestMotors again;
  feedback.update(0.03, again);
  EXPECT_EQ(again.strong, 1);
}

TEST(ForceEffects, LevelsBecomeTheKernelsNumbers) {
  const ff_effect rumble = rumbleEffect(1, 0.5, 7);
  EXPECT_EQ(rumble.type, FF_RUMBLE);
  EXPECT_EQ(rumble.id, 7);
  EXPECT_EQ(rumble.u.rumble.strong_magnitude, 0xffff);
  EXPECT_EQ(rumble.u.rumble.weak_magnitude, 0x8000);
  EXPECT_GT(rumble.replay.length, 0);  // ends by itself
  EXPECT_EQ(rumbleEffect(7, -3, -1).u.rumble.strong_magnitude, 0xffff);
  EXPECT_EQ(rumbleEffect(7, -3, -1).u.rumble.weak_magnitude, 0);
  EXPECT_EQ(rumbleEffect(std::nan(""), 0, -1).u.rumble.strong_magnitude, 0);
  const ff_effect spring = springEffect({{{-1, 0.5}, {2, 3}}}, -1);
  EXPECT_EQ(spring.u.condition[0].center, -0x7fff);
  EXPECT_EQ(spring.u.condition[0].left_coeff, 0x4000);
  EXPECT_EQ(spring.u.condition[0].right_coeff, 0x4000);
  EXPECT_EQ(spring.u.condition[1].center, 0x7fff);
  EXPECT_EQ(spring.u.condition[1].right_coeff, 0x7fff);
}

}  // namespace
}  // namespace vibe::hardware::pad_feedback_test
