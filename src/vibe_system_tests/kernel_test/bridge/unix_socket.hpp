#pragma once

#include <functional>
#include <string>

namespace vibe::hardware {

/// Makes a unix stream socket that listens at this path, without blocking. @return its descriptor  @throws
/// std::runtime_error
int listenAt(const std::string& path);

/// Connects to a unix stream socket, waiting until somebody listens there.
/// @param timeout  [s]
/// @return the descriptor  @throws std::runtime_error: nobody listened in time
int connectTo(const std::string& path, double timeout);

/// Accepts a connection and makes it non-blocking. @return its descriptor; -1: nobody has connected
/// @throws std::runtime_error
int acceptFrom(int listener);

/// Lines of text from the guest, one answer to each: the other end of a serial port of the virtual machine.
class CommandChannel {
 public:
  using Handler = std::function<std::string(const std::string& line)>;

  /// Listens on a unix socket. @throws std::runtime_error
  explicit CommandChannel(const std::string& socket_path);
  ~CommandChannel();
  CommandChannel(const CommandChannel&) = delete;
  CommandChannel& operator=(const CommandChannel&) = delete;

  int descriptor() const { return connection_ >= 0 ? connection_ : listener_; }

  /// Accepts the connection, or answers the lines that have come. @return false: the virtual machine has ended
  bool service(const Handler& handler);

 private:
  void answerLines(const Handler& handler);

  int listener_ = -1;
  int connection_ = -1;
  std::string received_;
};

}  // namespace vibe::hardware
