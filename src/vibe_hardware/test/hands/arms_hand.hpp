#pragma once

#include <string>
#include <vector>

#include "gamepad/pads.hpp"
#include "hands/held_arms.hpp"
#include "hands/simulated_stomach.hpp"
#include "vibe_hardware/crtk/teleop.hpp"

namespace vibe::hardware {

/// Emulated arms that drive the simulator by what crtk_teleop does, without nodes.
class ArmsHand : public HeldArms<SimulatedStomach> {
 public:
  /// @param mappings  names in config/arms
  explicit ArmsHand(const std::vector<std::string>& mappings) {
    for (const std::string& name : mappings)
      arms_.emplace_back(loadTeleopMapping("../config/arms/" + name + ".yaml", toolLimits()));
    for (const HeldArm& arm : arms_) {
      drives_.push_back({startTeleop(arm.mapping, 0), {}, {}});
      drives_.back().input.ready = true;
    }
  }

 protected:
  StepInput send() override {
    for (int k = 0; k < kSamples; ++k)
      for (std::size_t i = 0; i < arms_.size(); ++i) sample(arms_[i], drives_[i], stepPeriod() / kSamples);
    for (std::size_t i = 0; i < arms_.size(); ++i) publish(arms_[i].mapping, drives_[i].output);
    return step_;
  }

  void hear() override {
    for (Drive& drive : drives_) {
      drive.input.joints = simulation_.state().joints;
      drive.input.tissue.reset();
      if (!simulation_.toolImpedance()) continue;
      TissueResponse tissue;
      tissue.time = drive.state.time;
      for (std::size_t j = 0; j < kScopeJointCount; ++j) {
        const JointResponse& r = simulation_.toolImpedance()->joints[j];
        tissue.joints[j] = {r.position, r.effort, r.stiffness, r.damping, r.velocity};
      }
      drive.input.tissue = tissue;
    }
  }

 private:
  static constexpr int kSamples = 16;  // of an arm in a frame, about 1 kHz

  struct Drive {
    TeleopState state;
    TeleopInput input;
    TeleopOutput output;
  };
  std::vector<Drive> drives_;  // by arm
  StepInput step_;

  void sample(HeldArm& arm, Drive& drive, double dt) {
    moveArm(arm, dt);
    TeleopInput& input = drive.input;
    if (arm.mapping.gripper) input.gripper = arm.angle;
    input.clutch = isDown(arm.mapping.clutch);
    input.device = isDown(arm.mapping.device);
    for (std::size_t b = 0; b < kButtonCount; ++b) input.buttons[b] = isDown(arm.mapping.buttons[b]) ? 1 : 0;
    const double now = drive.state.time + dt;
    input.sample = ArmSample{now, arm.motion.position, orientationOf(arm.motion), arm.joints};
    drive.output = hardware::step(arm.mapping, toolLimits(), now, input, drive.state);
    input.sample.reset();
    feel(arm, drive.output.force, drive.output.torque);
  }

  /// As its node does.
  void publish(const TeleopMapping& mapping, const TeleopOutput& output) {
    for (std::size_t j = 0; j < kJointCount; ++j)
      if (j < kScopeJointCount ? output.moves_scope : output.moves_device) step_.joints[j] = output.joints[j];
    if (pressesButtons(mapping)) step_.buttons = output.buttons;
  }
};

}  // namespace vibe::hardware
