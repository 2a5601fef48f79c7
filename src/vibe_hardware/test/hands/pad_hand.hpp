#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "gamepad/pads.hpp"
#include "hands/simulated_stomach.hpp"

namespace vibe::hardware {

/// A pad in the hands of a person, who reads in its mapping what moves what.
class PadHand : public SimulatedStomach {
 public:
  /// @param mapping  name in config/gamepads
  PadHand(const std::string& mapping, PadState pad)
      : mapping_(shippedMapping(mapping)),
        pad_(std::move(pad)),
        drive_(startDrive(simulation_.state().joints, mapping_, pad_)) {}

  void steer(Joint joint, double by) override {
    const JointMapping& map = mapping_.joints[joint];
    const double put =
        controlFor(map, map.mode == JointMapping::Mode::Rate ? by / (kBrake * map.rate) : placeFor(joint, by));
    if (map.control == JointMapping::Control::Axis) return deflect(pad_, map.forward, put);
    for (const int code : {map.forward, map.backward}) {
      const double pressed = std::max(0.0, code == map.forward ? put : -put);
      if (map.control == JointMapping::Control::Axes) deflect(pad_, code, 2 * pressed - 1);
      if (map.control == JointMapping::Control::Buttons) hold(code, pressed > 0);
    }
  }

  void press(Button button, bool down) override {
    const ButtonMapping& map = mapping_.buttons[button];
    hold(map.code, down || map.toggle);
    if (map.toggle) frame(), hold(map.code, false);
  }

 protected:
  void act() override {}

  StepInput send() override {
    drive_ = followJoints(simulation_.state().joints, toolLimits(), drive_);
    drive_ = advance(mapping_, toolLimits(), pad_, drive_, simulation_.stepPeriod());
    StepInput input;
    input.joints = drive_.joints;
    input.buttons = drive_.buttons;
    return input;
  }

 private:
  static constexpr double kBrake = 0.25;  // in which it brings a joint to rest [s]

  PadMapping mapping_;
  PadState pad_;
  DriveState drive_;

  void hold(int code, bool down) {
    if (pad_.buttons[code].down != down) pad_.apply({0, EV_KEY, code, down ? 1 : 0});
  }

  /// Where a control that is a position has to be; first where its joint is, which it picks up.
  double placeFor(Joint joint, double by) const {
    const JointMapping& map = mapping_.joints[joint];
    const double wanted = simulation_.state().joints[joint] + (drive_.engaged[joint] ? by : 0);
    return 2 * (wanted - map.low) / (map.high - map.low) - 1;
  }

  /// Where a control has to be to count as this share of its way, from -1 to 1; a cross is pressed or not.
  double controlFor(const JointMapping& map, double share) const {
    if (share == 0) return 0;
    const auto axis = pad_.axes.find(map.forward);
    const bool cross = axis != pad_.axes.end() && axis->second.maximum - axis->second.minimum <= 2;
    const double response = std::pow(std::min(1.0, std::abs(share)), 1 / map.exponent);
    const double size = cross ? 1 : map.dead_zone + (1 - map.dead_zone) * response;
    return std::copysign(size, map.reversed ? -share : share);
  }
};

}  // namespace vibe::hardware
