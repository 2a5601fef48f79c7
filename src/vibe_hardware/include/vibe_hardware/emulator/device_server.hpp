#pragma once
#include <cstddef>
#include <cstdint>

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

}  // namespace vibe::hardware
