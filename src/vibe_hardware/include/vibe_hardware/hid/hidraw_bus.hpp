#pragma once
#include "vibe_hardware/hid/hid_port.hpp"

namespace vibe::hardware {

/// HID devices of the Linux kernel, through hidapi and /dev/hidraw*. Needs no root: see docs/hardware.md for the udev
/// rule. All ports share one library, so the last bus that is destroyed ends it.
class HidrawBus : public HidBus {
 public:
  /// Lists only devices of this vendor. @param vendor  0: of every vendor
  explicit HidrawBus(std::uint16_t vendor = 0);
  ~HidrawBus() override;
  HidrawBus(const HidrawBus&) = delete;
  HidrawBus& operator=(const HidrawBus&) = delete;

  std::vector<HidInfo> list() override;
  std::unique_ptr<HidPort> open(const std::string& path) override;

 private:
  std::uint16_t vendor_;
};

}  // namespace vibe::hardware
