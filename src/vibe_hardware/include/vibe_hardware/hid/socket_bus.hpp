#pragma once
#include <string>

#include "vibe_hardware/hid/hid_port.hpp"

namespace vibe::hardware {

/// $XDG_RUNTIME_DIR/vibe_emulator, or /tmp/vibe_emulator-UID without that variable.
std::string defaultSocketFolder();

/// Devices behind local sockets, as the emulator offers them: see socket_protocol.hpp. Sockets that nobody serves any
/// more, and those that do not answer as a device does, are not listed; list() throws if there are only devices of
/// another release.
class SocketBus : public HidBus {
 public:
  /// @param folder  of the sockets; need not exist yet
  explicit SocketBus(std::string folder) : folder_(std::move(folder)) {}

  std::vector<HidInfo> list() override;
  std::string remedyOfAbsence() const override;
  std::unique_ptr<HidPort> open(const std::string& path) override;

 private:
  std::string folder_;
  bool exists_ = false, serves_ = false;  // at the last list(): the folder, a device in it
};

}  // namespace vibe::hardware
