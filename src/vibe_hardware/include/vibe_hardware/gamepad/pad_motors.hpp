#pragma once
#include <array>

namespace vibe::hardware {

/// Spring of one axis of a stick: force = coefficient (centre - deflection), as a share of the device's greatest.
struct StickSpring {
  double centre = 0;       ///< deflection without force, -1 to 1
  double coefficient = 0;  ///< 0 to 1; 1: the greatest force at a distance of one half of the axis
};

/// The motors of a pad.
class PadMotors {
 public:
  virtual ~PadMotors() = default;

  virtual bool hasRumble() const = 0;
  virtual bool hasSpring() const = 0;
  /// @param strong, weak  of the heavy and the light motor, 0 to 1; ends by itself after half a second
  /// @return false if the device refuses it
  virtual bool rumble(double strong, double weak) = 0;
  /// @param springs  of ABS_X and ABS_Y; stays until the next call
  virtual bool spring(const std::array<StickSpring, 2>& springs) = 0;
};

}  // namespace vibe::hardware
