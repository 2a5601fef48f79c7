#include "command_channel.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>

#include "unix_socket.hpp"

namespace vibe::hardware {

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
