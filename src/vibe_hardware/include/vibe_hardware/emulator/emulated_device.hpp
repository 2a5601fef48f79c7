#pragma once
#include <array>
#include <cstdint>

#include "vibe_firmware/protocol/hid_function.hpp"
#include "vibe_firmware/protocol/reports.hpp"

namespace vibe::hardware {

constexpr double kTick = 1e-3;  ///< of the control loop [s]

/// What a person does at a device in one tick.
struct DeviceMotion {
  std::array<double, vibe_firmware::kAxisCount> intended{};  ///< where the hand wants the axes to be [rad]
  std::uint16_t buttons = 0;                                 ///< one bit each
};

/// A device that exists as a model only, with the real firmware in it. It knows no clock: tick() is a millisecond.
class EmulatedDevice {
 public:
  virtual ~EmulatedDevice() = default;

  virtual void tick(const DeviceMotion& motion) = 0;

  /// The input report that is due, if any: every ten ticks. @return whether there is one
  virtual bool nextReport(std::uint8_t (&bytes)[vibe_firmware::kInputReportSize]) = 0;

  /// Its USB side.
  virtual vibe_firmware::HidFunction& function() = 0;

  /// Switches the firmware off and on; the mechanics stay where they are, and counting begins at 0 there. Ends the life
  /// of function().
  virtual void restart() = 0;
};

}  // namespace vibe::hardware
