#include "plugged_device.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <stdexcept>

#include <fcntl.h>
#include <linux/hidraw.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include "vibe_firmware/protocol/descriptors.hpp"

namespace vibe::hardware {

HidrawFile::HidrawFile(const std::string& path) : file_(open(path.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK)) {
  if (file_ < 0) throw std::runtime_error("cannot open " + path + ": " + std::strerror(errno));
}

HidrawFile::~HidrawFile() {
  close(file_);
}

std::vector<std::uint8_t> HidrawFile::read(double timeout) {
  std::vector<std::uint8_t> bytes(64);
  pollfd wait{file_, POLLIN, 0};
  if (poll(&wait, 1, static_cast<int>(timeout * 1000)) <= 0) return {};
  const ssize_t size = ::read(file_, bytes.data(), bytes.size());
  bytes.resize(size < 0 ? 0 : size);
  return bytes;
}

std::vector<std::uint8_t> HidrawFile::getFeature(std::uint8_t id) {
  std::vector<std::uint8_t> bytes(64);
  bytes[0] = id;
  const int size = ioctl(file_, HIDIOCGFEATURE(64), bytes.data());
  bytes.resize(size < 0 ? 0 : size);
  return bytes;
}

int HidrawFile::setFeature(const std::vector<std::uint8_t>& bytes) {
  std::vector<std::uint8_t> copy = bytes;
  return ioctl(file_, HIDIOCSFEATURE(copy.size()), copy.data()) < 0 ? errno : 0;
}

std::vector<std::uint8_t> HidrawFile::reportDescriptor() const {
  int size = 0;
  hidraw_report_descriptor descriptor{};
  if (ioctl(file_, HIDIOCGRDESCSIZE, &size) < 0) return {};
  descriptor.size = static_cast<std::uint32_t>(size);
  if (ioctl(file_, HIDIOCGRDESC, &descriptor) < 0) return {};
  return {descriptor.value, descriptor.value + descriptor.size};
}

namespace {

constexpr const char* kSerialPort = "/dev/ttyS1";
constexpr double kTimeout = 20;  // [s]

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
    if (poll(&wait, 1, static_cast<int>(1000 * kTimeout)) <= 0 || read(file, &c, 1) != 1) {
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

namespace {

using vibe_firmware::kHapticProductId;
using vibe_firmware::kInputProductId;

}  // namespace

void PluggedDevice::beginPlug() {
  if (plugged_) return;
  tellBridge("plug " + name_);
  plugged_ = true;
}

void PluggedDevice::beginUnplug() {
  if (!plugged_) return;
  tellBridge("unplug " + name_);
  plugged_ = false;
  keeps_polling_.reset();
}

const UsbNodes& PluggedDevice::plug() {
  beginPlug();
  if (nodes_) return *nodes_;
  const auto complete = [this] { return (nodes_ = findUsbNodes(usb_)).has_value(); };
  if (!events_.waitUntil(complete, kTimeout)) {
    throw std::runtime_error("no hidraw, event and js node of the " + name_ + " device after 20 s");
  }
  keeps_polling_ = std::make_unique<HidrawFile>(nodes_->hidraw);
  return *nodes_;
}

void PluggedDevice::unplug() {
  beginUnplug();
  if (!events_.waitUntil([this] { return !isKnown(usb_); }, kTimeout)) {
    throw std::runtime_error("the kernel still has the " + name_ + " device 20 s after it was pulled out");
  }
  nodes_.reset();
}

bool imageRuns() {
  const char* image = std::getenv("VIBE_IMAGE");
  return image && *image;
}

PluggedDevice& hapticDevice() {
  static PluggedDevice device("haptic", {kHapticProductId, "bridge-haptic"});
  return device;
}

PluggedDevice& inputDevice() {
  static PluggedDevice device("input", {kInputProductId, "bridge-input"});
  return device;
}

PluggedDevice& imageDevice() {
  static PluggedDevice device("image", {kHapticProductId, "QEMU"});
  return device;
}

PluggedDevice& spareHapticDevice() {
  static PluggedDevice device("spare-haptic", {kHapticProductId, "bridge-spare-haptic"});
  return device;
}

PluggedDevice& spareInputDevice() {
  static PluggedDevice device("spare-input", {kInputProductId, "bridge-spare-input"});
  return device;
}

}  // namespace vibe::hardware
