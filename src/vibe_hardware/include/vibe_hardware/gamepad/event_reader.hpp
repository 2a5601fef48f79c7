#pragma once
#include <cstdint>
#include <functional>

#include "vibe_hardware/gamepad/event_port.hpp"

namespace vibe::hardware {

/// Keeps the state of a pad up to date from its events, also across lost ones.
class EventReader {
 public:
  /// @param initial  state of the pad when it was opened
  EventReader(EventPort& port, PadState initial) : port_(port), state_(std::move(initial)) {}

  /// Takes over everything that waits. @return false: the device is gone
  bool update();

  const PadState& state() const { return state_; }
  std::uint64_t eventCount() const { return event_count_; }
  std::uint64_t dropCount() const { return drop_count_; }  ///< times that the kernel's queue overflowed

  /// Called with every event, for a recording.
  void setListener(std::function<void(const PadEvent&)> listener) { listener_ = std::move(listener); }

 private:
  EventPort& port_;
  PadState state_;
  std::uint64_t event_count_ = 0;
  std::uint64_t drop_count_ = 0;
  std::function<void(const PadEvent&)> listener_;

  void take(const PadEvent& event);
};

}  // namespace vibe::hardware
