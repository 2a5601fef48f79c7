#pragma once
#include "vibe_core/input/step_input.hpp"

namespace vibe {

/// Whether a joint slides [m]; the others turn [rad].
constexpr bool isPrismatic(int joint) {
  return joint == Insertion || joint == HelixAdvance || joint == NeedleDriver;
}
/// "m" or "rad": of its position.
constexpr const char* jointUnit(int joint) {
  return isPrismatic(joint) ? "m" : "rad";
}
/// "m/s" or "rad/s": of its speed.
constexpr const char* jointSpeedUnit(int joint) {
  return isPrismatic(joint) ? "m/s" : "rad/s";
}

}  // namespace vibe
