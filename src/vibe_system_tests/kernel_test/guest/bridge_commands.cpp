#include "bridge_commands.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <mutex>
#include <stdexcept>

namespace vibe::hardware {
namespace {

constexpr const char* kSerialPort = "/dev/ttyS1";
constexpr int kTimeout = 20000;  // [ms]

int openSerialPort() {
  const int file = open(kSerialPort, O_RDWR | O_NOCTTY | O_CLOEXEC);
  termios settings{};
  if (file < 0 || tcgetattr(file, &settings) != 0) {
    throw std::runtime_error(std::string("cannot open ") + kSerialPort + ": " + std::strerror(errno));
  }
  cfmakeraw(&settings);
  cfsetspeed(&settings, B115200);
  settings.c_cflag |= CLOCAL;
  tcsetattr(file, TCSANOW, &settings);
  return file;
}

std::string readLine(int file) {
  std::string line;
  for (char c = 0; c != '\n'; line += c) {
    pollfd wait{file, POLLIN, 0};
    if (poll(&wait, 1, kTimeout) <= 0 || read(file, &c, 1) != 1) {
      throw std::runtime_error("the bridge does not answer");
    }
  }
  line.pop_back();
  return line;
}

/// While it lives, no other thread and no other process uses the serial port.
class Turn {
 public:
  explicit Turn(int file) : lock_(mutex_), file_(file) { flock(file_, LOCK_EX); }
  ~Turn() { flock(file_, LOCK_UN); }

 private:
  inline static std::mutex mutex_;
  std::lock_guard<std::mutex> lock_;
  int file_;
};

}  // namespace

void tellBridge(const std::string& command) {
  static const int file = openSerialPort();
  const Turn turn(file);
  const std::string line = command + "\n";
  if (write(file, line.data(), line.size()) != static_cast<ssize_t>(line.size())) {
    throw std::runtime_error("cannot write to the bridge");
  }
  const std::string answer = readLine(file);
  if (answer != "ok") throw std::runtime_error("bridge, asked to '" + command + "': " + answer);
}

}  // namespace vibe::hardware
