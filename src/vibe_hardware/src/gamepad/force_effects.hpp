#pragma once
#include <linux/input.h>

#include <array>

#include "vibe_hardware/gamepad/pad_motors.hpp"

namespace vibe::hardware {

constexpr int kRumbleTime = 500;  ///< a program that hangs must not leave the pad shaking [ms]

/// The kernel's effects for levels; levels beyond their range are limited, values that are not finite count as 0.
/// @param id  of the effect to replace; -1: a new one
ff_effect rumbleEffect(double strong, double weak, int id);
ff_effect springEffect(const std::array<StickSpring, 2>& springs, int id);

}  // namespace vibe::hardware
