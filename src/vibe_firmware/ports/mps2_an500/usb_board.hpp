#pragma once

#include <array>
#include <cstdint>

#include "tick_timer.hpp"
#include "vibe_firmware/core/haptic_device.hpp"
#include "vibe_firmware/hal/board.hpp"

namespace vibe_firmware::mps2 {

/// Encoders and buttons of a board that has none. Until somebody sets them they move by a fixed script: axis 0 and 1
/// go to and fro between -10,000 and 10,000 counts in 4 s and 6 s, and one of six buttons is pressed for each half
/// second.
class SimulatedEncoders {
 public:
  static constexpr std::int32_t kMaxSpeed = 20;  ///< [counts per tick]; a jump would look like a broken encoder

  /// Of the next tick; time and index are left 0.
  HapticSample next();

  /// Ends the script: the encoders move to these counts at kMaxSpeed and stay there. Called from the main loop, with
  /// interrupts enabled.
  void moveTo(const std::array<std::int32_t, kAxisCount>& counts, std::uint16_t buttons);

 private:
  void followScript();

  std::array<std::int32_t, kAxisCount> counts_{};
  std::array<std::int32_t, kAxisCount> targets_{};
  std::uint16_t buttons_ = 0;
  std::uint32_t tick_ = 0;
  bool scripted_ = true;
};

/// mps2-an500 with simulated encoders and without motors: what the USB images run on.
class UsbBoard : public Board {
 public:
  explicit UsbBoard(SimulatedEncoders& encoders) : encoders_(encoders) {}

  HapticSample sample() override {
    HapticSample sample = encoders_.next();
    sample.time_us = clock_.update();
    return sample;
  }
  void writeTorque(const std::array<float, kAxisCount>&) override {}
  void feedWatchdog() override {}

 private:
  SimulatedEncoders& encoders_;
  MicrosecondClock clock_;
};

}  // namespace vibe_firmware::mps2
