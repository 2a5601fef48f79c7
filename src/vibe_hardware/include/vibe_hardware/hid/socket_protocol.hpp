#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

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

constexpr std::uint8_t kSocketVersion = 1;
constexpr std::size_t kMaxPacket = 8192;  ///< bytes; no packet is longer
constexpr const char* kSocketSuffix = ".hid";

enum PacketKind : std::uint8_t { kHello = 'H', kInput = 'I', kGet = 'G', kSet = 'S', kReply = 'R' };

using Packet = std::vector<std::uint8_t>;

/// What a device says of itself.
struct Hello {
  std::uint16_t vendor = 0, product = 0;
  std::string serial, name;
  std::vector<std::uint8_t> report_descriptor;
};

Packet packHello(const Hello& hello);
/// Empty: the packet is not a hello of this version.
std::optional<Hello> unpackHello(const std::uint8_t* bytes, std::size_t size);

}  // namespace vibe::hardware
