#pragma once
#include <cstdint>
#include <functional>

#include "vibe_hardware/gamepad/pad_motors.hpp"
#include "vibe_hardware/gamepad/pad_state.hpp"

namespace vibe::hardware {

/// A pad that is there: a device, or a recording of one.
class PadSource {
 public:
  virtual ~PadSource() = default;

  virtual const PadInfo& info() const = 0;
  /// Brings the state up to date. Never waits. @param now  steady time [s]. @return false: the pad is gone
  virtual bool update(double now) = 0;
  virtual const PadState& state() const = 0;
  /// null: it has none
  virtual PadMotors* motors() = 0;

  virtual std::uint64_t eventCount() const = 0;
  virtual std::uint64_t dropCount() const = 0;  ///< times that events were lost and the state was read anew
  /// Called with every event, for a recording.
  virtual void setListener(std::function<void(const PadEvent&)> listener) = 0;
};

}  // namespace vibe::hardware
