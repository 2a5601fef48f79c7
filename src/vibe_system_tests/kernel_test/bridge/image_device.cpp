#include "image_device.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "unix_socket.hpp"

namespace vibe::hardware {
namespace {

constexpr double kConnectTimeout = 20;  // [s]
constexpr int kAnswerTimeout = 5000;    // [ms]; an emulated board on a busy computer
constexpr int kStall = vibe_firmware::ControlEndpoint::kStall;

std::uint8_t low(std::uint16_t value) {
  return static_cast<std::uint8_t>(value & 0xFF);
}
std::uint8_t high(std::uint16_t value) {
  return static_cast<std::uint8_t>(value >> 8);
}

}  // namespace

ImageDevice::ImageDevice(const std::string& socket_path) : connection_(connectTo(socket_path, kConnectTimeout)) {}

ImageDevice::~ImageDevice() {
  close(connection_);
}

int ImageDevice::control(const vibe_firmware::UsbSetup& setup, const std::uint8_t* data, std::uint8_t* response,
                         std::size_t capacity) {
  std::vector<std::uint8_t> frame{'S',
                                  setup.request_type,
                                  setup.request,
                                  low(setup.value),
                                  high(setup.value),
                                  low(setup.index),
                                  high(setup.index),
                                  low(setup.length),
                                  high(setup.length)};
  if (!(setup.request_type & 0x80) && data) frame.insert(frame.end(), data, data + setup.length);
  if (::send(connection_, frame.data(), frame.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(frame.size()))
    return kStall;
  Frame answer;
  for (;;) {
    while (takeFrame(answer)) {
      if (answer.type == 'I') {
        reports_.push_back(answer.bytes);
        continue;
      }
      if (answer.result < 0) return kStall;
      const std::size_t size = std::min(answer.bytes.size(), capacity);
      std::copy_n(answer.bytes.begin(), size, response);
      return static_cast<int>(size);
    }
    if (!readMore(kAnswerTimeout)) {
      std::fprintf(stderr, "usb_bridge: the firmware image does not answer\n");
      return kStall;
    }
  }
}

void ImageDevice::reset() {
  ::send(connection_, "R", 1, MSG_NOSIGNAL);
}

void ImageDevice::service(const ReportSink& sink) {
  while (readMore(0)) {
  }
  Frame frame;
  while (takeFrame(frame)) {
    if (frame.type == 'I') reports_.push_back(frame.bytes);
  }
  for (const auto& report : reports_) sink(report.data(), report.size());
  reports_.clear();
}

bool ImageDevice::takeFrame(Frame& frame) {
  const auto& b = received_;
  if (b.size() < 2) return false;
  const bool is_report = b[0] == 'I';
  const std::size_t header = is_report ? 2 : 3;
  if (b.size() < header) return false;
  frame.type = static_cast<char>(b[0]);
  frame.result = is_report ? b[1] : static_cast<std::int16_t>(b[1] | b[2] << 8);
  const std::size_t size = std::max(frame.result, 0);
  if (b.size() < header + size) return false;
  frame.bytes.assign(b.begin() + header, b.begin() + header + size);
  received_.erase(received_.begin(), received_.begin() + header + size);
  return true;
}

bool ImageDevice::readMore(int timeout_ms) {
  pollfd wait{connection_, POLLIN, 0};
  if (poll(&wait, 1, timeout_ms) <= 0) return false;
  std::uint8_t bytes[512];
  const ssize_t size = recv(connection_, bytes, sizeof bytes, MSG_DONTWAIT);
  if (size <= 0) return false;
  received_.insert(received_.end(), bytes, bytes + size);
  return true;
}

}  // namespace vibe::hardware
