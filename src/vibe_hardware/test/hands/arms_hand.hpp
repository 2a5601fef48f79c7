#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gamepad/pads.hpp"
#include "hands/simulated_stomach.hpp"
#include "vibe_hardware/crtk/teleop.hpp"
#include "vibe_hardware/emulator/emulated_arm.hpp"

namespace vibe::hardware {

/// One or two emulated arms with pedals in the hands of a person, who reads in their mappings what moves what.
class ArmsHand : public SimulatedStomach {
 public:
  /// @param mappings  names in config/arms
  explicit ArmsHand(const std::vector<std::string>& mappings) {
    for (const std::string& name : mappings)
      arms_.emplace_back(loadTeleopMapping("../config/arms/" + name + ".yaml", toolLimits()));
  }

  void steer(Joint joint, double by) override {
    joint_ = joint;
    by_ = by;
  }

  void press(Button button, bool down) override {
    for (Arm& arm : arms_) {
      const ArmButton& control = arm.mapping.buttons[static_cast<std::size_t>(button)];
      if (arm.mapping.gripper && arm.mapping.gripper->button == button) squeeze(arm, down);
      if (control.topic.empty()) continue;
      if (control.during != ArmButton::While::Always) changeOver(arm, control.during == ArmButton::While::Device);
      hold(control, control.toggle || down);
      if (control.toggle) frame(), hold(control, false);
    }
  }

  int clutched() const { return clutched_; }  ///< how often a hand has come back

 protected:
  void act() override {
    if (by_ == 0) return;
    for (Arm& arm : arms_) {
      const HandJoint& map = arm.mapping.joints[static_cast<std::size_t>(joint_)];
      const auto& gripper = arm.mapping.gripper;
      if (gripper && gripper->joint == joint_) arm.squeezes = (by_ > 0) == (gripper->at_closed > gripper->at_open);
      if (map.coordinate < 0) continue;
      changeOver(arm, joint_ >= kScopeJointCount);
      moveHand(arm, static_cast<std::size_t>(map.coordinate), by_ / map.scale);
    }
  }

  StepInput send() override {
    for (int k = 0; k < kSamples; ++k)
      for (Arm& arm : arms_) sample(arm, simulation_.stepPeriod() / kSamples);
    for (const Arm& arm : arms_) publish(arm);
    return step_;
  }

  void hear() override {
    for (Arm& arm : arms_) {
      arm.input.joints = simulation_.state().joints;
      arm.input.tissue.reset();
      if (!simulation_.toolImpedance()) continue;
      TissueResponse tissue;
      tissue.time = arm.state.time;
      for (std::size_t j = 0; j < kScopeJointCount; ++j) {
        const JointResponse& r = simulation_.toolImpedance()->joints[j];
        tissue.joints[j] = {r.position, r.effort, r.stiffness, r.damping, r.velocity};
      }
      arm.input.tissue = tissue;
    }
  }

 private:
  static constexpr int kSamples = 16;  // of an arm in a frame, about 1 kHz
  // How far a hand goes to both sides: a small desktop arm [m], and a wrist [rad]. An arm without a clutch is larger.
  static constexpr double kWay = 0.035, kTurn = 1.5, kLargeArm = 10;
  static constexpr double kSqueeze = 2;  // [rad/s]

  struct Arm {
    explicit Arm(TeleopMapping of) : mapping(std::move(of)), state(startTeleop(mapping, 0)) {
      if (mapping.gripper) angle = mapping.gripper->open;
      input.ready = true;
    }
    TeleopMapping mapping;
    TeleopState state;
    TeleopInput input;
    EmulatedArmState motion;
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), torque = Eigen::Vector3d::Zero();
    std::array<double, kHandCoordinates> hand{};    // where the person intends to have it
    std::array<double, kHandCoordinates> joints{};  // of one that measures them
    bool squeezes = false;
    double angle = 0;  // of the gripper
    TeleopOutput output;
  };

  std::vector<Arm> arms_;
  std::map<std::pair<std::string, int>, bool> down_;  // buttons and pedals
  Joint joint_ = Insertion;
  double by_ = 0;
  int clutched_ = 0;
  StepInput step_;

  void hold(const ArmButton& control, bool down) { down_[{control.topic, control.index}] = down; }
  bool isDown(const ArmButton& control) const {
    const auto found = down_.find({control.topic, control.index});
    return found != down_.end() && found->second;
  }

  void squeeze(Arm& arm, bool closed) {
    arm.squeezes = closed;
    while (arm.angle != (closed ? arm.mapping.gripper->closed : arm.mapping.gripper->open)) frame();
  }

  void changeOver(Arm& arm, bool device) {
    const ArmButton& control = arm.mapping.device;
    if (control.topic.empty() || isDown(control) == (device != control.reversed)) return;
    hold(control, device != control.reversed);
    frame();
  }

  void moveHand(Arm& arm, std::size_t c, double rest) {
    const bool turns = arm.mapping.arm_joints.empty() ? c >= HandRoll : arm.mapping.arm_joints[c] == "roll";
    const double room = arm.mapping.clutch.topic.empty() ? kLargeArm : turns ? kTurn : kWay;
    const double speed = (turns ? 2.0 : 0.12) * simulation_.stepPeriod();
    const double next = arm.hand[c] + std::clamp(0.2 * rest, -speed, speed);
    if (std::abs(next) > room) return reachBack(arm, c, std::copysign(0.8 * room, -next), 3 * speed);
    arm.hand[c] = next;
  }

  void reachBack(Arm& arm, std::size_t c, double to, double speed) {
    hold(arm.mapping.clutch, true);
    ++clutched_;
    while (arm.hand[c] != to) {
      arm.hand[c] += std::clamp(to - arm.hand[c], -speed, speed);
      frame();
    }
    for (int k = 0; k < 15; ++k) frame();  // until the hand rests
    hold(arm.mapping.clutch, false);
  }

  void sample(Arm& arm, double dt) {
    const TeleopMapping& mapping = arm.mapping;
    HandIntent intent;
    intent.position = mapping.hand * Eigen::Vector3d(arm.hand[HandX], arm.hand[HandY], arm.hand[HandZ]);
    intent.turn = mapping.hand * Eigen::Vector3d(arm.hand[HandRoll], arm.hand[HandPitch], arm.hand[HandYaw]);
    for (int k = 0; k < 5; ++k) stepArm({}, dt / 5, arm.force, arm.torque, intent, arm.motion);
    if (mapping.gripper) {
      const double way = (arm.squeezes ? mapping.gripper->closed : mapping.gripper->open) - arm.angle;
      arm.angle += std::clamp(way, -kSqueeze * dt, kSqueeze * dt);
      arm.input.gripper = arm.angle;
    }
    arm.input.clutch = isDown(mapping.clutch);
    arm.input.device = isDown(mapping.device);
    for (std::size_t b = 0; b < kButtonCount; ++b) arm.input.buttons[b] = isDown(mapping.buttons[b]) ? 1 : 0;
    arm.input.sample = ArmSample{arm.state.time + dt, arm.motion.position, orientationOf(arm.motion), {}};
    for (std::size_t c = 0; c < mapping.arm_joints.size(); ++c) {
      const double step = (mapping.arm_joints[c] == "roll" ? 4 : 0.4) * dt;
      arm.joints[c] += std::clamp(arm.hand[c] - arm.joints[c], -step, step);
    }
    arm.input.sample->joints = arm.joints;
    arm.output = hardware::step(mapping, toolLimits(), arm.state.time + dt, arm.input, arm.state);
    arm.input.sample.reset();
    arm.force =
        mapping.force_frame == ForceFrame::Body ? orientationOf(arm.motion) * arm.output.force : arm.output.force;
    arm.torque =
        mapping.force_frame == ForceFrame::Body ? orientationOf(arm.motion) * arm.output.torque : arm.output.torque;
  }

  /// As its node does.
  void publish(const Arm& arm) {
    for (std::size_t j = 0; j < kJointCount; ++j)
      if (j < kScopeJointCount ? arm.output.moves_scope : arm.output.moves_device)
        step_.joints[j] = arm.output.joints[j];
    if (pressesButtons(arm.mapping)) step_.buttons = arm.output.buttons;
  }
};

}  // namespace vibe::hardware
