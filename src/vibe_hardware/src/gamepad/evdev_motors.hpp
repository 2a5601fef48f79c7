#pragma once
#include <linux/input.h>

#include "vibe_hardware/gamepad/pad_motors.hpp"

namespace vibe::hardware {

/// Motors of a device of the kernel: one rumble and one spring effect, replaced in place.
class EvdevMotors : public PadMotors {
 public:
  EvdevMotors(int fd, bool has_rumble, bool has_spring) : fd_(fd), has_rumble_(has_rumble), has_spring_(has_spring) {}
  ~EvdevMotors() override;
  EvdevMotors(const EvdevMotors&) = delete;
  EvdevMotors& operator=(const EvdevMotors&) = delete;

  bool hasRumble() const override { return has_rumble_; }
  bool hasSpring() const override { return has_spring_; }
  bool rumble(double strong, double weak) override;
  bool spring(const std::array<StickSpring, 2>& springs) override;

 private:
  int fd_;
  bool has_rumble_, has_spring_;
  int rumble_id_ = -1;  // of the kernel; -1: not uploaded yet
  int spring_id_ = -1;

  bool play(ff_effect effect, int& id);
  void erase(int& id);
};

}  // namespace vibe::hardware
