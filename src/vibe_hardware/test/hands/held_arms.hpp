#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "vibe_hardware/crtk/teleop_mapping.hpp"
#include "vibe_hardware/emulator/emulated_arm.hpp"
#include "vibe_testing/whole_bite.hpp"

namespace vibe::hardware {

/// Emulated arms with grippers and pedals in the hands of a person, who reads in their mappings what moves what.
/// @tparam World  a test::HandAtDevice without steer() and press(), which calls act() before it looks; frame() lets
/// stepPeriod() pass
template <class World>
class HeldArms : public World {
 public:
  void steer(Joint joint, double by) override {
    joint_ = joint;
    by_ = by;
  }

  void press(Button button, bool down) override {
    for (HeldArm& arm : arms_) {
      const ArmButton& control = arm.mapping.buttons[static_cast<std::size_t>(button)];
      if (arm.mapping.gripper && arm.mapping.gripper->button == button) squeeze(arm, down);
      if (control.topic.empty()) continue;
      if (control.during != ArmButton::While::Always) changeOver(arm, control.during == ArmButton::While::Device);
      hold(control, control.toggle || down);
      if (control.toggle) this->frame(), hold(control, false);
    }
  }

  int clutched() const { return clutched_; }  ///< how often a hand has come back

 protected:
  struct HeldArm {
    explicit HeldArm(TeleopMapping of) : mapping(std::move(of)) {
      if (mapping.gripper) angle = mapping.gripper->open;
    }
    TeleopMapping mapping;
    EmulatedArmState motion;
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), torque = Eigen::Vector3d::Zero();  // in the base [N], [N m]
    std::array<double, kHandCoordinates> hand{};    // where the person intends to have it
    std::array<double, kHandCoordinates> joints{};  // of one that measures them
    bool squeezes = false;
    double angle = 0;  // of the gripper
  };

  std::vector<HeldArm> arms_;

  /// A button or pedal goes down or comes up.
  virtual void pressed(const ArmButton& /*control*/, bool /*down*/) {}

  void act() override {
    if (by_ == 0) return;
    for (HeldArm& arm : arms_) {
      const HandJoint& map = arm.mapping.joints[static_cast<std::size_t>(joint_)];
      const auto& gripper = arm.mapping.gripper;
      if (gripper && gripper->joint == joint_) arm.squeezes = (by_ > 0) == (gripper->at_closed > gripper->at_open);
      if (map.coordinate < 0) continue;
      changeOver(arm, joint_ >= kScopeJointCount);
      moveHand(arm, static_cast<std::size_t>(map.coordinate), by_ / map.scale);
    }
  }

  bool isDown(const ArmButton& control) const {
    const auto found = down_.find({control.topic, control.index});
    return found != down_.end() && found->second;
  }

  /// The handle, the gripper and what the arm measures go on. @param dt  1 ms or so [s]
  void moveArm(HeldArm& arm, double dt) const {
    const TeleopMapping& mapping = arm.mapping;
    HandIntent intent;
    intent.position = mapping.hand * Eigen::Vector3d(arm.hand[HandX], arm.hand[HandY], arm.hand[HandZ]);
    intent.turn = mapping.hand * Eigen::Vector3d(arm.hand[HandRoll], arm.hand[HandPitch], arm.hand[HandYaw]);
    for (int k = 0; k < 5; ++k) stepArm({}, dt / 5, arm.force, arm.torque, intent, arm.motion);
    if (mapping.gripper) {
      const double way = (arm.squeezes ? mapping.gripper->closed : mapping.gripper->open) - arm.angle;
      arm.angle += std::clamp(way, -kSqueeze * dt, kSqueeze * dt);
    }
    for (std::size_t c = 0; c < mapping.arm_joints.size(); ++c) {
      const double step = (mapping.arm_joints[c] == "roll" ? 4 : 0.4) * dt;
      arm.joints[c] += std::clamp(arm.hand[c] - arm.joints[c], -step, step);
    }
  }

  /// What is sent to the arm, in the axes that its mapping names. [N], [N m]
  static void feel(HeldArm& arm, const Eigen::Vector3d& force, const Eigen::Vector3d& torque) {
    const bool body = arm.mapping.force_frame == ForceFrame::Body;
    const Eigen::Quaterniond frame = body ? orientationOf(arm.motion) : Eigen::Quaterniond::Identity();
    arm.force = frame * force;
    arm.torque = frame * torque;
  }

 private:
  // How far a hand goes to both sides: a small desktop arm [m], and a wrist [rad]. An arm without a clutch is larger.
  static constexpr double kWay = 0.035, kTurn = 1.5, kLargeArm = 10;
  static constexpr double kSqueeze = 2;  // [rad/s]

  std::map<std::pair<std::string, int>, bool> down_;  // buttons and pedals
  Joint joint_ = Insertion;
  double by_ = 0;
  int clutched_ = 0;

  void hold(const ArmButton& control, bool down) {
    bool& was = down_[{control.topic, control.index}];
    if (was != down) pressed(control, down);
    was = down;
  }

  void squeeze(HeldArm& arm, bool closed) {
    arm.squeezes = closed;
    while (arm.angle != (closed ? arm.mapping.gripper->closed : arm.mapping.gripper->open)) this->frame();
  }

  void changeOver(HeldArm& arm, bool device) {
    const ArmButton& control = arm.mapping.device;
    if (control.topic.empty() || isDown(control) == (device != control.reversed)) return;
    hold(control, device != control.reversed);
    this->frame();
  }

  void moveHand(HeldArm& arm, std::size_t c, double rest) {
    const bool turns = arm.mapping.arm_joints.empty() ? c >= HandRoll : arm.mapping.arm_joints[c] == "roll";
    const double room = arm.mapping.clutch.topic.empty() ? kLargeArm : turns ? kTurn : kWay;
    const double speed = (turns ? 2.0 : 0.12) * this->stepPeriod();
    const double next = arm.hand[c] + std::clamp(0.2 * rest, -speed, speed);
    if (std::abs(next) > room) return reachBack(arm, c, std::copysign(0.8 * room, -next), 3 * speed);
    arm.hand[c] = next;
  }

  void reachBack(HeldArm& arm, std::size_t c, double to, double speed) {
    hold(arm.mapping.clutch, true);
    ++clutched_;
    while (arm.hand[c] != to) {
      arm.hand[c] += std::clamp(to - arm.hand[c], -speed, speed);
      this->frame();
    }
    for (int k = 0; k < 15; ++k) this->frame();  // until the hand rests
    hold(arm.mapping.clutch, false);
  }
};

}  // namespace vibe::hardware
