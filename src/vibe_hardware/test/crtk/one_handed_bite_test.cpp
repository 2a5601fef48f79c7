// One hand at one arm performs a whole bite: emulated arm, shipped mapping, teleoperation, simulator; without ROS.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "gamepad/pads.hpp"
#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/simulation/simulation.hpp"
#include "vibe_hardware/crtk/teleop.hpp"
#include "vibe_hardware/emulator/emulated_arm.hpp"

namespace vibe::hardware::one_handed_bite_test {
namespace {

using Kind = Event::Kind;
constexpr int kSamples = 16;  // of the arm in a frame, about 1 kHz
// How far the hand goes to both sides: a small desktop arm [m], and a wrist [rad].
constexpr double kWay = 0.035, kTurn = 1.5;

std::shared_ptr<const Model> defaultModel() {
  const Scene scene = loadScene("../../vibe_core/scenes/stomach.yaml");
  return buildModel(scene, readTextFile("../../vibe_description/urdf/scope.urdf", "URDF"));
}

/// A person with one arm and some pedals, who watches the joints and moves the hand until they are where they should
/// be.
class OneHand {
 public:
  OneHand() { input_.ready = true; }

  void press(Button button, bool down) { step_.buttons[static_cast<std::size_t>(button)] = down ? 1 : 0; }
  void wait(double seconds) {
    for (const double end = simulation_.time() + seconds; simulation_.time() < end;) frame();
  }
  /// Until a joint is where it should be; with the clutch the hand comes back whenever it cannot go on. @return whether
  bool reach(Joint joint, double target) {
    input_.device = joint >= kScopeJointCount;
    frame();
    const HandJoint& map = mapping_.joints[static_cast<std::size_t>(joint)];
    const auto c = static_cast<std::size_t>(map.coordinate);
    const bool turns = map.coordinate >= HandRoll;
    const double room = turns ? kTurn : kWay, speed = (turns ? 2.0 : 0.12) * simulation_.stepPeriod();
    for (int k = 0; k < 300; ++k) {
      const double rest = (target - step_.joints[static_cast<std::size_t>(joint)]) / map.scale;
      if (std::abs(rest) < 1e-4) return true;
      const double next = hand_[c] + std::clamp(0.2 * rest, -speed, speed);
      if (std::abs(next) > room) {
        reachBack(c, next > 0 ? -0.8 * room : 0.8 * room, 3 * speed);
        continue;
      }
      hand_[c] = next;
      frame();
    }
    return false;
  }

  int count(Kind kind) const { return events_.count(kind) > 0 ? events_.at(kind) : 0; }
  const StepInput& commanded() const { return step_; }
  double felt() const { return felt_; }  ///< largest force on the hand [N]
  int clutched() const { return clutched_; }

 private:
  TeleopMapping mapping_ = loadTeleopMapping("../config/arms/touch_alone.yaml", toolLimits());
  Simulation simulation_{defaultModel()};
  TeleopState state_ = startTeleop(mapping_, 0);
  TeleopInput input_;
  EmulatedArmConfig config_;
  EmulatedArmState arm_;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero(), torque_ = Eigen::Vector3d::Zero();
  std::array<double, kHandCoordinates> hand_{};  // where the person intends to have it
  StepInput step_;
  double time_ = 0, felt_ = 0;
  int clutched_ = 0;
  std::map<Kind, int> events_;

  void reachBack(std::size_t coordinate, double to, double speed) {
    input_.clutch = true;
    ++clutched_;
    while (hand_[coordinate] != to) {
      hand_[coordinate] += std::clamp(to - hand_[coordinate], -speed, speed);
      frame();
    }
    for (int k = 0; k < 15; ++k) frame();  // until the hand rests
    input_.clutch = false;
    frame();
  }

  void frame() {
    for (int k = 0; k < kSamples; ++k) sample(simulation_.stepPeriod() / kSamples);
    step_.joints = state_.joints;
    for (const Event& event : simulation_.step(step_)) ++events_[event.kind];
    input_.joints = step_.joints;
    input_.tissue.reset();
    if (!simulation_.toolImpedance()) return;
    TissueResponse tissue;
    tissue.time = time_;
    for (std::size_t j = 0; j < kScopeJointCount; ++j) {
      const JointResponse& r = simulation_.toolImpedance()->joints[j];
      tissue.joints[j] = {r.position, r.effort, r.stiffness, r.damping, r.velocity};
    }
    input_.tissue = tissue;
  }

  void sample(double dt) {
    HandIntent intent;
    intent.position = mapping_.hand * Eigen::Vector3d(hand_[HandX], hand_[HandY], hand_[HandZ]);
    intent.turn = mapping_.hand * Eigen::Vector3d(hand_[HandRoll], hand_[HandPitch], hand_[HandYaw]);
    for (int k = 0; k < 5; ++k) stepArm(config_, dt / 5, force_, torque_, intent, arm_);
    time_ += dt;
    input_.sample = ArmSample{time_, arm_.position, orientationOf(arm_), {}};
    const TeleopOutput output = step(mapping_, toolLimits(), time_, input_, state_);
    input_.sample.reset();
    force_ = output.force, torque_ = output.torque;
    felt_ = std::max(felt_, force_.norm());
  }
};

TEST(OneHandedBite, OneArmMovesScopeHelixAndNeedleArm) {
  OneHand hand;
  hand.press(Insufflate, true);
  EXPECT_TRUE(hand.reach(Insertion, 0.08));
  EXPECT_TRUE(hand.reach(Rotation, -M_PI / 2));
  EXPECT_TRUE(hand.reach(TipUpDown, 0.5236));
  EXPECT_TRUE(hand.reach(HelixAdvance, 0.028));
  while (hand.count(Kind::PressureReached) == 0) hand.wait(0.1);
  EXPECT_TRUE(hand.reach(Insertion, 0.1086));
  hand.press(HelixGrab, true);
  hand.wait(0.3);
  const StepInput at_the_wall = hand.commanded();
  EXPECT_TRUE(hand.reach(HelixRotation, 20.7));
  EXPECT_TRUE(hand.reach(HelixAdvance, 0.005));
  EXPECT_TRUE(hand.reach(NeedleDriver, 0.0179));
  hand.press(Needle, true);
  hand.wait(0.4);
  hand.press(Needle, false);
  EXPECT_TRUE(hand.reach(NeedleDriver, 0.0002));
  for (int j = 0; j < kScopeJointCount; ++j)  // while the device moved, the scope was where it had been
    EXPECT_EQ(hand.commanded().joints[static_cast<std::size_t>(j)], at_the_wall.joints[static_cast<std::size_t>(j)]);
  EXPECT_LT(hand.felt(), 0.02);
  EXPECT_TRUE(hand.reach(Insertion, 0.102));  // pulls at what the helix holds
  EXPECT_GT(hand.felt(), 0.2);
  EXPECT_TRUE(hand.reach(Insertion, 0.1086));
  EXPECT_TRUE(hand.reach(HelixAdvance, 0.025));
  hand.press(HelixGrab, false);
  hand.wait(0.2);
  for (const Kind kind : {Kind::PressureReached, Kind::Grab, Kind::HelixTurned, Kind::Bite, Kind::Release})
    EXPECT_EQ(hand.count(kind), 1) << static_cast<int>(kind);
  for (const Kind mistake : {Kind::GrabMissed, Kind::Slip, Kind::BiteMissed, Kind::BiteWithdrawn, Kind::Rejected})
    EXPECT_EQ(hand.count(mistake), 0) << static_cast<int>(mistake);
  EXPECT_GE(hand.clutched(), 2);
}

}  // namespace
}  // namespace vibe::hardware::one_handed_bite_test
