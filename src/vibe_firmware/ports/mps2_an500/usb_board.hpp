#pragma once
#include "simulated_encoders.hpp"
#include "tick_timer.hpp"
#include "vibe_firmware/hal/board.hpp"

namespace vibe_firmware::mps2 {

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
