#include "unix_socket.hpp"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <stdexcept>
#include <thread>

namespace vibe::hardware {
namespace {

sockaddr_un addressOf(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) {
    throw std::runtime_error("the path of the socket " + path + " is too long; use a folder with a shorter path");
  }
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  return address;
}

int newSocket(int flags) {
  const int descriptor = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | flags, 0);
  if (descriptor < 0) throw std::runtime_error(std::string("no socket: ") + std::strerror(errno));
  return descriptor;
}

[[noreturn]] void failed(int descriptor, const std::string& what, const std::string& path) {
  const std::string reason = std::strerror(errno);
  close(descriptor);
  throw std::runtime_error("cannot " + what + " " + path + ": " + reason);
}

}  // namespace

int listenAt(const std::string& path) {
  const sockaddr_un address = addressOf(path);
  const int descriptor = newSocket(SOCK_NONBLOCK);
  if (bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      listen(descriptor, 1) != 0) {
    failed(descriptor, "listen at", path);
  }
  return descriptor;
}

int connectTo(const std::string& path, double timeout) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(timeout);
  const sockaddr_un address = addressOf(path);
  const int descriptor = newSocket(0);
  while (connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    if (Clock::now() > end) failed(descriptor, "connect to", path);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return descriptor;
}

int acceptFrom(int listener) {
  const int descriptor = accept4(listener, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
  if (descriptor < 0 && errno != EAGAIN)
    throw std::runtime_error(std::string("cannot accept a connection: ") + std::strerror(errno));
  return descriptor;
}

}  // namespace vibe::hardware
