#pragma once
#include "vibe_core/state/state.hpp"

namespace vibe::benchmarks {

constexpr double kApproach = 0.05;   ///< speed of the scope until it touches [m/s]
constexpr double kTouch = 0.2;       ///< force that shows that the tip presses the far wall, not the entry [N]
constexpr double kClearance = 2e-3;  ///< of the scope before it presses or rams [m]

/// The command to stay there, with the insufflator on.
inline StepInput holdAt(const State& state) {
  StepInput input;
  input.joints = state.joints;
  input.buttons[Insufflate] = 1;
  return input;
}

}  // namespace vibe::benchmarks
