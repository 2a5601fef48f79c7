#include "hidraw_file.hpp"

#include <fcntl.h>
#include <linux/hidraw.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

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

}  // namespace vibe::hardware
