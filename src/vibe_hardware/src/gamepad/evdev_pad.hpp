#pragma once
#include <map>

#include "gamepad/evdev_device.hpp"
#include "gamepad/evdev_motors.hpp"
#include "gamepad/evdev_port.hpp"
#include "vibe_hardware/gamepad/event_reader.hpp"
#include "vibe_hardware/gamepad/pad_source.hpp"

namespace vibe::hardware {

/// A pad of the kernel. While it is open, the kernel's own filters of its axes (fuzz, flat) are off where the
/// permissions allow: they swallow small moves. Dead zones are the mapping's.
class EvdevPad : public PadSource {
 public:
  explicit EvdevPad(EvdevDevice device, const std::string& path);
  ~EvdevPad() override;
  EvdevPad(const EvdevPad&) = delete;
  EvdevPad& operator=(const EvdevPad&) = delete;

  const PadInfo& info() const override { return info_; }
  bool update(double) override { return reader_.update(); }
  const PadState& state() const override { return reader_.state(); }
  PadMotors* motors() override { return info_.has_rumble || info_.has_spring ? &motors_ : nullptr; }
  std::uint64_t eventCount() const override { return reader_.eventCount(); }
  std::uint64_t dropCount() const override { return reader_.dropCount(); }
  void setListener(std::function<void(const PadEvent&)> listener) override { reader_.setListener(std::move(listener)); }

 private:
  EvdevDevice device_;
  PadInfo info_;
  EvdevPort port_;
  EventReader reader_;
  EvdevMotors motors_;
  std::map<unsigned, input_absinfo> filtered_;  // axes whose filters were switched off, as they were

  void clearFilters();
  void restoreFilters();
};

}  // namespace vibe::hardware
