#pragma once
#include <array>
#include <cstdint>

#include "vibe_core/input/step_input.hpp"

namespace vibe::hardware {

/// What a hand intends at one time. The device follows as far as its mechanics and the forces allow.
struct HandSample {
  std::array<double, kJointCount> joints{};          ///< in the order of vibe::Joint [m], [rad]
  std::array<std::uint8_t, kButtonCount> buttons{};  ///< in the order of vibe::Button; 1 while pressed
};

/// A hand that moves an endoscope by itself. A pure function of time: at(t) gives the same values on every call.
class Hand {
 public:
  virtual ~Hand() = default;

  /// @param time  since the start [s]; from 0
  virtual HandSample at(double time) const = 0;

  /// After this time nothing changes any more [s]; infinite for a hand that never ends.
  virtual double duration() const = 0;
};

}  // namespace vibe::hardware
