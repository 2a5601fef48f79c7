#include "unix_socket.hpp"

#include <cerrno>
#include <chrono>
#include <cstring>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

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

CommandChannel::CommandChannel(const std::string& socket_path) : listener_(listenAt(socket_path)) {}

CommandChannel::~CommandChannel() {
  if (connection_ >= 0) close(connection_);
  close(listener_);
}

bool CommandChannel::service(const Handler& handler) {
  if (connection_ < 0) connection_ = acceptFrom(listener_);
  if (connection_ < 0) return true;
  char bytes[256];
  const ssize_t size = read(connection_, bytes, sizeof bytes);
  if (size == 0 || (size < 0 && errno != EAGAIN && errno != EINTR)) return false;
  if (size > 0) received_.append(bytes, size);
  answerLines(handler);
  return true;
}

void CommandChannel::answerLines(const Handler& handler) {
  for (auto end = received_.find('\n'); end != std::string::npos; end = received_.find('\n')) {
    const std::string line = received_.substr(0, end);
    received_.erase(0, end + 1);
    const std::string answer = handler(line) + "\n";
    send(connection_, answer.data(), answer.size(), MSG_NOSIGNAL);
  }
}

}  // namespace vibe::hardware
