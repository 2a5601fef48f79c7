#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "vibe_hardware/emulator/usb_host.hpp"
#include "vibe_hardware/hid/file_descriptor.hpp"
#include "vibe_hardware/hid/socket_bus.hpp"

namespace vibe::hardware {

/// Makes an emulated device reachable for hosts. All functions return at once, whatever a host does.
class DeviceServer {
 public:
  virtual ~DeviceServer() = default;

  /// Sends an input report to all hosts.
  virtual void publish(const std::uint8_t* report, std::size_t size) = 0;

  /// Accepts hosts and answers requests that have arrived.
  virtual void serve() = 0;

  /// Input reports that were thrown away because a host did not read them.
  virtual std::uint64_t droppedReports() const = 0;
};

/// Serves a device on a local socket: see socket_bus.hpp and SocketBus in it, which is the other side.
///
/// A host that does not read loses the oldest input reports; one that does not read its replies, or sends packets that
/// are not of the protocol, is disconnected. The destructor disconnects everybody and removes the socket, which is what
/// unplugging a device is.
class SocketServer : public DeviceServer {
 public:
  static constexpr std::size_t kMaxHosts = 16;           ///< more are turned away
  static constexpr std::size_t kMaxWaitingReports = 64;  ///< per host, as in hidraw
  static constexpr std::size_t kMaxWaitingReplies = 16;  ///< per host
  static constexpr int kMaxRequestsPerServe = 4;         ///< per host

  /// @param folder  made if it does not exist, for the present user only
  /// @param name    of the socket file, without suffix
  /// @param device  has to live as long as the server
  /// @throws std::runtime_error with the remedy
  SocketServer(const std::string& folder, const std::string& name, UsbHost& device);
  ~SocketServer() override;

  void publish(const std::uint8_t* report, std::size_t size) override;
  void serve() override;
  std::uint64_t droppedReports() const override { return dropped_; }

  std::size_t hostCount() const { return hosts_.size(); }  ///< connected at present
  /// Hosts that were disconnected because of what they did.
  std::uint64_t expelledHosts() const { return expelled_; }
  const std::string& path() const { return path_; }  ///< of the socket file

 private:
  struct Host {
    FileDescriptor file;
    std::deque<Packet> replies, reports;  // replies go first
  };
  enum class Outcome { Stays, Leaves, Expelled };

  void accept();
  Outcome serveHost(Host& host);
  Outcome readRequests(Host& host);
  bool answer(const Packet& request, Host& host);
  Outcome flush(Host& host);

  UsbHost& device_;
  std::string path_;
  FileDescriptor listener_;
  std::vector<Host> hosts_;
  std::uint64_t dropped_ = 0, expelled_ = 0;
};

/// Hands a device to the kernel through /dev/uhid: it then has a hidraw node and is a gamepad, as if it were on USB.
/// Needs a kernel with CONFIG_UHID and the right to write to /dev/uhid. The destructor removes the device.
class UhidServer : public DeviceServer {
 public:
  /// @param device  has to live as long as the server
  /// @throws std::runtime_error with the remedy
  explicit UhidServer(UsbHost& device);
  ~UhidServer() override;

  void publish(const std::uint8_t* report, std::size_t size) override;
  void serve() override;
  std::uint64_t droppedReports() const override { return dropped_; }

 private:
  void create();
  bool writeEvent(const void* event);

  UsbHost& device_;
  FileDescriptor file_;
  std::uint64_t dropped_ = 0;
};

}  // namespace vibe::hardware
