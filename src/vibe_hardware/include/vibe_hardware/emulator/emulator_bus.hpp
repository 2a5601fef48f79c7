#pragma once
#include <array>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "vibe_hardware/emulator/emulator.hpp"
#include "vibe_hardware/emulator/usb_host.hpp"
#include "vibe_hardware/hid/hid_port.hpp"

namespace vibe::hardware {

/// The devices of an emulator in the same program, in virtual time: for drivers in tests and studies. Time passes only
/// in Emulator::tick(), so no call waits. Each device can be opened once at a time.
class EmulatorBus : public HidBus {
 public:
  /// @param emulator  has to live as long as the bus, and the bus as long as its ports
  explicit EmulatorBus(Emulator& emulator);
  ~EmulatorBus() override;

  /// Takes the reports that are due; to be called after each tick.
  void collect();

  std::vector<HidInfo> list() override;
  std::unique_ptr<HidPort> open(const std::string& path) override;

 private:
  class Port;
  struct Device;
  std::array<std::unique_ptr<Device>, kDeviceKinds> devices_;
};

}  // namespace vibe::hardware
