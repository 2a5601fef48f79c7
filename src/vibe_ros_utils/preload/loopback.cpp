// Preloaded by scripts/run (LD_PRELOAD): TCP servers listen on the loopback interface instead of on all of them. With
// ROS_HOSTNAME=localhost roscpp does so for its data, but its XML-RPC server always binds to all interfaces. The port
// VIBE_OPEN_PORT is let be: that of a page, whose server asks for a token.
#include <arpa/inet.h>
#include <dlfcn.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cstdlib>
#include <cstring>

namespace {

using Bind = int (*)(int, const sockaddr*, socklen_t);

bool isTcp(int socket) {
  int type = 0;
  socklen_t size = sizeof type;
  return getsockopt(socket, SOL_SOCKET, SO_TYPE, &type, &size) == 0 && type == SOCK_STREAM;
}

bool isOpen(in_port_t port) {
  const char* open = std::getenv("VIBE_OPEN_PORT");
  return port != 0 && open != nullptr && ntohs(port) == std::strtol(open, nullptr, 10);
}

void closeToTheNetwork(sockaddr_storage& address) {
  // of both families at the same place
  if (isOpen(reinterpret_cast<sockaddr_in&>(address).sin_port)) return;
  if (address.ss_family == AF_INET) {
    auto& in = reinterpret_cast<sockaddr_in&>(address);
    if (in.sin_addr.s_addr == htonl(INADDR_ANY)) in.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  } else if (address.ss_family == AF_INET6) {
    auto& in = reinterpret_cast<sockaddr_in6&>(address);
    if (IN6_IS_ADDR_UNSPECIFIED(&in.sin6_addr)) in.sin6_addr = in6addr_loopback;
  }
}

}  // namespace

extern "C" int bind(int socket, const sockaddr* address, socklen_t length) noexcept {
  static const Bind next = reinterpret_cast<Bind>(dlsym(RTLD_NEXT, "bind"));
  if (address == nullptr || length > sizeof(sockaddr_storage) || !isTcp(socket)) return next(socket, address, length);
  sockaddr_storage closed{};
  std::memcpy(&closed, address, length);
  closeToTheNetwork(closed);
  return next(socket, reinterpret_cast<const sockaddr*>(&closed), length);
}
