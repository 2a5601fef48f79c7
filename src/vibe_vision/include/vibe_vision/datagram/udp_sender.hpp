#pragma once
#include <sys/socket.h>

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

namespace vibe::vision {

/// Sends datagrams to one address; never waits and never receives. A receiver that is not there is no error.
class UdpSender {
 public:
  /// @param target  "host:port", or "[address]:port" for IPv6. @throws Error if it cannot be understood or resolved
  explicit UdpSender(const std::string& target);
  ~UdpSender();
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  void send(const std::vector<std::uint8_t>& bytes);
  std::uint64_t sent() const { return sent_; }      ///< datagrams that the system took
  std::uint64_t failed() const { return failed_; }  ///< datagrams that the system did not take

 private:
  int socket_ = -1;
  sockaddr_storage address_{};
  socklen_t address_size_ = 0;
  std::atomic<std::uint64_t> sent_{0}, failed_{0};
};

}  // namespace vibe::vision
