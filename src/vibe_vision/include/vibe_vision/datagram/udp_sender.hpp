#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace vibe {

/// Sends datagrams to one address; never waits and never receives.
class UdpSender {
 public:
  /// @param target  "host:port". @throws Error if it cannot be understood or resolved
  explicit UdpSender(const std::string& target);
  ~UdpSender();
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  void send(const std::vector<std::uint8_t>& bytes);
  std::uint64_t failed() const { return failed_; }  ///< datagrams that the system did not take

 private:
  int socket_ = -1;
  std::uint64_t failed_ = 0;
};

}  // namespace vibe
