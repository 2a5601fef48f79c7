#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "vibe_hardware/hid/hid_port.hpp"

// How a HID device is reached through a local socket instead of a kernel: what a host needs of hidraw, in packets of a
// unix socket of type SOCK_SEQPACKET. A device is a socket file FOLDER/NAME.hid; who connects is a host. A device
// serves several hosts; each of them gets every input report. Numbers are little-endian.
//
// | packet | from | bytes |
// |---|---|---|
// | hello | device, first packet | 'H', version, vendor u16, product u16, then serial, name, report descriptor, each as
// length u16 and bytes | | input | device | 'I', report with its id | | get | host | 'G', number, report id | | set |
// host | 'S', number, report with its id | | reply | device | 'R', number of the request, status (0: done, 1: stall),
// report with its id after a get |
//
// A host has one request at a time under way and ignores replies with another number. A packet that does not fit this
// table ends the connection.

namespace vibe::hardware {

constexpr std::uint8_t kSocketVersion = 1;     ///< second byte of a hello; a host talks to its own version only
constexpr std::size_t kMaxPacket = 8192;       ///< bytes; no packet is longer
constexpr const char* kSocketSuffix = ".hid";  ///< of a socket file of a device

/// First byte of a packet: what it is, as the table says.
enum PacketKind : std::uint8_t { kHello = 'H', kInput = 'I', kGet = 'G', kSet = 'S', kReply = 'R' };

using Packet = std::vector<std::uint8_t>;  ///< one message: the socket keeps its limits

/// What a device says of itself.
struct Hello {
  std::uint16_t vendor = 0, product = 0;        ///< USB ids
  std::string serial, name;                     ///< may be empty
  std::vector<std::uint8_t> report_descriptor;  ///< as of USB
};

/// The packet of a hello. Texts and descriptor have at most 65535 bytes each.
Packet packHello(const Hello& hello);
/// Empty: the packet is not a hello of this version.
std::optional<Hello> unpackHello(const std::uint8_t* bytes, std::size_t size);

/// $XDG_RUNTIME_DIR/vibe_emulator, or /tmp/vibe_emulator-UID without that variable.
std::string defaultSocketFolder();

/// Devices behind local sockets, as the emulator offers them: see the table above. Sockets that nobody serves any
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
