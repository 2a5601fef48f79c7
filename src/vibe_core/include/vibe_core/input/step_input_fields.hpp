#pragma once
#include <cstdint>

#include "vibe_core/common/fields.hpp"
#include "vibe_core/input/step_input.hpp"

namespace vibe {

/// Version of StepInput's fields, which recordings carry. Raise it with every change of the list below.
///   1: joints and buttons
///   2: with pull_particle and pull_target
constexpr std::uint32_t kStepInputVersion = 2;

VIBE_FIELDS(StepInput, joints, buttons, pull_particle, pull_target);

}  // namespace vibe
