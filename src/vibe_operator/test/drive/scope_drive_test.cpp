#include "vibe_operator/drive/scope_drive.hpp"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <random>
#include <set>
#include <vector>

namespace vibe::operating::scope_drive_test {
namespace {

constexpr double kPi = 3.14159265358979;

JointLimits urdfLimits() {
  return {{{0, 0.3, 0.15},
           {-kPi, kPi, kPi},
           {-1.5708, 2.8623, kPi},
           {-1.7453, 1.7453, kPi},
           {0, 0.03, 0.1},
           {-50.27, 50.27, 25.13},
           {0, 0.018, 0.1}}};
}

const Joints kStart = {0.12, 0.5, 0.3, -0.2, 0.01, 2, 0.005};

struct ScopeDriveTest : testing::Test {
  std::vector<std::pair<int, bool>> changes;
  ScopeDrive drive{[this](int button, bool down) { changes.emplace_back(button, down); }};

  ScopeDriveTest() { drive.begin(urdfLimits(), kStart); }
};

TEST_F(ScopeDriveTest, BeginsWhereTheSimulatorIs) {
  EXPECT_EQ(drive.joints(), kStart);
  drive.advance(3);
  EXPECT_EQ(drive.joints(), kStart) << "no key is down";
  EXPECT_TRUE(drive.atRest());
}

TEST_F(ScopeDriveTest, EveryJointHasAKeyInBothDirections) {
  std::array<double, kJointCount> up{}, down{};
  for (const KeyBinding& binding : keyBindings()) {
    if (binding.kind != KeyBinding::Kind::Joint) continue;
    drive.begin(urdfLimits(), kStart);
    drive.keyDown(binding.key);
    drive.advance(0.2);
    const Joints now = drive.joints();
    for (std::size_t i = 0; i < now.size(); ++i) {
      const double by = now[i] - kStart[i];
      EXPECT_EQ(by != 0, static_cast<int>(i) == binding.index) << "key " << binding.key << ", joint " << i;
      up[i] = std::max(up[i], by);
      down[i] = std::min(down[i], by);
    }
    drive.keyUp(binding.key);
  }
  for (std::size_t i = 0; i < up.size(); ++i) {
    EXPECT_GT(up[i], 0) << driveJointNames()[i];
    EXPECT_LT(down[i], 0) << driveJointNames()[i];
  }
}

TEST_F(ScopeDriveTest, MovesAtTheSpeedOfTheKey) {
  drive.keyDown('W');
  drive.advance(0.5);
  const double before = drive.joints()[Insertion];
  drive.advance(1);
  EXPECT_NEAR(drive.joints()[Insertion] - before, DriveSpeeds().keys[Insertion], 1e-12);
  drive.keyUp('W');
  drive.advance(1);
  EXPECT_TRUE(drive.atRest());
}

TEST_F(ScopeDriveTest, NoTapIsLostHoweverShort) {
  for (const KeyBinding& binding : keyBindings()) {
    if (binding.kind != KeyBinding::Kind::Joint) continue;
    const auto i = static_cast<std::size_t>(binding.index);
    for (const double seconds : {0.0, 1e-6, 0.003, 0.01}) {
      drive.begin(urdfLimits(), kStart);
      drive.keyDown(binding.key);
      drive.advance(seconds);
      drive.keyUp(binding.key);
      drive.advance(0.5);
      const double step = DriveSpeeds().keys[i] / 60;
      EXPECT_GE(binding.sign * (drive.joints()[i] - kStart[i]), step - 1e-9) << binding.key << ", " << seconds << " s";
      EXPECT_LE(binding.sign * (drive.joints()[i] - kStart[i]), 2 * step) << binding.key << ", " << seconds << " s";
      EXPECT_TRUE(drive.atRest());
    }
  }
}

TEST_F(ScopeDriveTest, ATapCountsFromWhereTheJointIsPutMeanwhile) {
  drive.keyDown('W');
  drive.advance(0.5);
  Joints elsewhere = kStart;
  elsewhere[Insertion] = 0.01;
  drive.begin(urdfLimits(), elsewhere);
  drive.keyUp('W');
  drive.advance(1);
  EXPECT_NEAR(drive.joints()[Insertion], 0.01 + DriveSpeeds().keys[Insertion] / 60, 1e-9);
}

TEST_F(ScopeDriveTest, GearsAndShiftScaleTheSpeed) {
  const auto speed = [this] {
    drive.advance(0.3);
    const double before = drive.joints()[Rotation];
    drive.advance(0.1);
    return (drive.joints()[Rotation] - before) / 0.1 / DriveSpeeds().keys[Rotation];
  };
  const DriveSpeeds speeds;
  drive.keyDown('D');
  EXPECT_NEAR(speed(), 1, 1e-9);
  drive.keyDown(keys::kShift);
  EXPECT_NEAR(speed(), speeds.slow, 1e-9);
  drive.keyUp(keys::kShift);
  EXPECT_NEAR(speed(), 1, 1e-9);
  drive.keyDown('3');
  drive.keyUp('3');
  EXPECT_NEAR(speed(), speeds.fast, 1e-9);
  drive.keyDown(keys::kShift);
  EXPECT_NEAR(speed(), speeds.slow, 1e-9) << "Shift is slow in every gear";
  drive.keyUp(keys::kShift);
  drive.keyDown('1');
  EXPECT_NEAR(speed(), speeds.slow, 1e-9);
}

TEST_F(ScopeDriveTest, OppositeKeysCancel) {
  drive.keyDown(keys::kUp);
  drive.keyDown(keys::kDown);
  drive.advance(1);
  EXPECT_EQ(drive.joints(), kStart);
  drive.keyUp(keys::kDown);
  drive.advance(1);
  EXPECT_GT(drive.joints()[TipUpDown], kStart[TipUpDown]);
}

TEST_F(ScopeDriveTest, RepeatedKeyDownCountsOnce) {
  for (int i = 0; i < 5; ++i) drive.keyDown('G');
  drive.keyUp('G');
  drive.keyUp('G');
  EXPECT_EQ(changes, (std::vector<std::pair<int, bool>>{{1, true}, {1, false}}));
}

TEST_F(ScopeDriveTest, EveryButtonHasAKey) {
  for (const int key : std::initializer_list<int>{keys::kSpace, 'G', 'N', 'T', 'C', 'I'}) {
    drive.keyDown(key);
    drive.keyUp(key);
  }
  ASSERT_EQ(changes.size(), 12u);
  for (int button = 0; button < 6; ++button) {
    EXPECT_EQ(changes[static_cast<std::size_t>(2 * button)], std::make_pair(button, true));
    EXPECT_EQ(changes[static_cast<std::size_t>(2 * button + 1)], std::make_pair(button, false));
  }
}

TEST_F(ScopeDriveTest, ReleaseAllLiftsButtonsAndBrakes) {
  for (const int key : std::initializer_list<int>{'W', keys::kSpace, keys::kLeft}) drive.keyDown(key);
  drive.advance(1);
  const double before = drive.joints()[Insertion];
  drive.releaseAll();
  EXPECT_TRUE(drive.keysDown().empty());
  EXPECT_EQ(changes.back(), std::make_pair(0, false));
  drive.advance(1);
  EXPECT_TRUE(drive.atRest());
  EXPECT_GT(drive.joints()[Insertion], before) << "it brakes, it does not jump";
  EXPECT_LT(drive.joints()[Insertion], before + 0.002);
  const Joints rest = drive.joints();
  drive.advance(5);
  EXPECT_EQ(drive.joints(), rest);
}

TEST_F(ScopeDriveTest, ReleaseJointsBrakesAndLeavesButtonsAlone) {
  for (const int key : std::initializer_list<int>{'W', keys::kSpace, keys::kShift}) drive.keyDown(key);
  drive.advance(1);
  drive.releaseJoints();
  EXPECT_EQ(drive.keysDown(), (std::set<int>{keys::kSpace, keys::kShift}));
  EXPECT_EQ(changes.size(), 1u);
  drive.advance(1);
  EXPECT_TRUE(drive.atRest());
  drive.keyUp('W');
  const Joints rest = drive.joints();
  drive.advance(1);
  EXPECT_EQ(drive.joints(), rest) << "it came up already";
}

TEST_F(ScopeDriveTest, UnknownKeysDoNothing) {
  for (const int key : std::initializer_list<int>{0, -1, 'M', keys::kEscape}) {
    drive.keyDown(key);
    drive.advance(0.1);
    drive.keyUp(key);
  }
  EXPECT_EQ(drive.joints(), kStart);
  EXPECT_TRUE(changes.empty());
}

TEST_F(ScopeDriveTest, MouseMovesByADistance) {
  drive.displace(TipUpDown, 0.2);
  drive.displace(TipUpDown, 0.1);
  drive.displace(Insertion, -0.01);
  drive.advance(2);
  EXPECT_NEAR(drive.joints()[TipUpDown], kStart[TipUpDown] + 0.3, 1e-9);
  EXPECT_NEAR(drive.joints()[Insertion], kStart[Insertion] - 0.01, 1e-9);
  drive.keyDown(keys::kShift);
  drive.displace(TipUpDown, -0.2);
  drive.advance(2);
  EXPECT_NEAR(drive.joints()[TipUpDown], kStart[TipUpDown] + 0.3 - 0.2 * DriveSpeeds().slow, 1e-9);
}

TEST_F(ScopeDriveTest, MouseBeyondTheLimitLeavesNoDebt) {
  drive.displace(TipLeftRight, 100);
  drive.advance(5);
  EXPECT_EQ(drive.joints()[TipLeftRight], 1.7453);
  drive.displace(TipLeftRight, -0.1);
  drive.advance(5);
  EXPECT_NEAR(drive.joints()[TipLeftRight], 1.6453, 1e-9);
  drive.displace(TipLeftRight, std::nan(""));
  drive.advance(1);
  EXPECT_NEAR(drive.joints()[TipLeftRight], 1.6453, 1e-9);
}

/// A key that goes down or up, or a motion of the mouse, and the time until the next one.
struct Event {
  double seconds;
  int key;
  bool down;
  double drag;
};

std::vector<Event> randomPlay(std::mt19937& random, std::size_t length) {
  std::uniform_real_distribution<double> share(0, 1);
  std::uniform_int_distribution<std::size_t> key(0, keyBindings().size() - 1);
  std::vector<Event> events(length);
  for (Event& event : events)
    event = {0.4 * share(random), keyBindings()[key(random)].key, share(random) < 0.6,
             share(random) < 0.2 ? share(random) - 0.5 : 0};
  return events;
}

void apply(const Event& event, ScopeDrive& drive) {
  if (event.drag != 0) drive.displace(TipUpDown, event.drag);
  if (event.down)
    drive.keyDown(event.key);
  else
    drive.keyUp(event.key);
}

TEST(ScopeDriveProperties, LimitsHoldAndVelocityHasNoStep) {
  std::mt19937 random(11);
  const JointLimits limits = urdfLimits();
  const double dt = 1.0 / 240;
  for (int run = 0; run < 20; ++run) {
    ScopeDrive drive([](int, bool) {});
    drive.begin(limits, kStart);
    Joints last = drive.joints(), last_velocity{};
    for (const Event& event : randomPlay(random, 80)) {
      apply(event, drive);
      for (double t = 0; t < event.seconds; t += dt) {
        drive.advance(dt);
        const Joints now = drive.joints();
        for (std::size_t i = 0; i < now.size(); ++i) {
          const double velocity = (now[i] - last[i]) / dt;
          ASSERT_GE(now[i], limits[i].lower);
          ASSERT_LE(now[i], limits[i].upper);
          ASSERT_LE(std::abs(velocity), limits[i].velocity + 1e-6);
          ASSERT_LE(std::abs(velocity - last_velocity[i]), limits[i].velocity / 0.3 * dt + 1e-5) << "a step at " << i;
          last_velocity[i] = velocity;
        }
        last = now;
      }
    }
  }
}

TEST(ScopeDriveProperties, PlayDoesNotDependOnTheFrameRate) {
  std::mt19937 random(5);
  for (int run = 0; run < 20; ++run) {
    ScopeDrive slow([](int, bool) {}), quick([](int, bool) {});
    slow.begin(urdfLimits(), kStart);
    quick.begin(urdfLimits(), kStart);
    for (const Event& event : randomPlay(random, 80)) {
      apply(event, slow);
      apply(event, quick);
      slow.advance(event.seconds);
      for (int i = 0; i < 37; ++i) quick.advance(event.seconds / 37);
      for (std::size_t i = 0; i < kStart.size(); ++i) ASSERT_NEAR(slow.joints()[i], quick.joints()[i], 1e-7);
    }
  }
}

}  // namespace
}  // namespace vibe::operating::scope_drive_test
