#include "vibe_vision/datagram/udp_sender.hpp"

#include <netdb.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

#include "vibe_core/common/error.hpp"

namespace vibe::vision {
namespace {

constexpr int kLargestPort = 65535;

[[noreturn]] void fail(const std::string& target, const std::string& problem) {
  throw Error("The address '" + target + "' for datagrams " + problem +
              "; write host:port, for example 127.0.0.1:9870.");
}

/// Host and port of "host:port" or "[address]:port".
std::pair<std::string, std::string> split(const std::string& target) {
  const std::size_t colon = target.rfind(':');
  if (colon == std::string::npos || colon == 0) fail(target, "has no host and port");
  std::string host = target.substr(0, colon);
  const std::string port = target.substr(colon + 1);
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
  } else if (host.find(':') != std::string::npos) {
    fail(target, "has more than one ':' (put an IPv6 address in brackets)");
  }
  const bool digits = !port.empty() && port.find_first_not_of("0123456789") == std::string::npos && port.size() <= 5;
  if (!digits || std::stoi(port) < 1 || std::stoi(port) > kLargestPort) fail(target, "has no port from 1 to 65535");
  return {host, port};
}

}  // namespace

UdpSender::UdpSender(const std::string& target) {
  const auto [host, port] = split(target);
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int status = getaddrinfo(host.c_str(), port.c_str(), &hints, &found);
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, freeaddrinfo);
  if (status != 0) fail(target, std::string("cannot be resolved (") + gai_strerror(status) + ")");
  // not connected: a receiver that is not there yet must not make later datagrams fail
  socket_ = socket(found->ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (socket_ < 0) fail(target, std::string("cannot be used (") + std::strerror(errno) + ")");
  std::memcpy(&address_, found->ai_addr, found->ai_addrlen);
  address_size_ = found->ai_addrlen;
}

UdpSender::~UdpSender() {
  if (socket_ >= 0) close(socket_);
}

void UdpSender::send(const std::vector<std::uint8_t>& bytes) {
  const auto* address = reinterpret_cast<const sockaddr*>(&address_);
  const ssize_t taken = sendto(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL, address, address_size_);
  ++(taken == static_cast<ssize_t>(bytes.size()) ? sent_ : failed_);
}

}  // namespace vibe::vision
