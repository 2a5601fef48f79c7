#pragma once
#include <usbredirparser.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "usb_device.hpp"

namespace vibe::hardware {

/// A USB port of a virtual machine: the "usb-host" side of one usbredir connection (protocol 0.7). A device is plugged
/// in and pulled out while the connection stays.
class RedirPort {
 public:
  /// What the port does wrong on purpose, to show that the tests of the guest notice it.
  struct Faults {
    int reports_to_lose = 0;     ///< so many of the next input reports do not reach the guest
    int reports_to_repeat = 0;   ///< so many of the next input reports reach the guest twice
    int answers_to_corrupt = 0;  ///< one bit is flipped in so many of the next answers to GET_REPORT
  };

  /// Listens on a unix socket. @throws std::runtime_error
  explicit RedirPort(const std::string& socket_path);
  ~RedirPort();
  RedirPort(const RedirPort&) = delete;
  RedirPort& operator=(const RedirPort&) = delete;

  void plug(std::unique_ptr<UsbDevice> device);
  void unplug();
  bool plugged() const { return device_ != nullptr; }

  /// File descriptors that service() waits for; -1: none.
  std::array<int, 2> descriptors() const;

  /// Does what is due. @return false: the virtual machine has closed the connection
  bool service();

  Faults& faults() { return faults_; }

 private:
  struct Callbacks;  ///< of the parser

  void announce();
  std::vector<std::uint8_t> askDescriptor(std::uint8_t type);
  void sendReport(const std::uint8_t* bytes, std::size_t size);
  void send(const std::uint8_t* bytes, std::size_t size);
  void answer(std::uint64_t id, usb_redir_control_packet_header header, const std::uint8_t* data);
  void flush();

  int listener_ = -1;
  int connection_ = -1;
  usbredirparser* parser_ = nullptr;
  std::unique_ptr<UsbDevice> device_;
  bool greeted_ = false;    ///< the virtual machine has said hello
  bool receiving_ = false;  ///< the guest polls the interrupt endpoint
  Faults faults_;
};

}  // namespace vibe::hardware
