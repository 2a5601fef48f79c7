#include "firmware_device.hpp"

#include <sys/timerfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

#include "scripted_hand.hpp"
#include "vibe_firmware/protocol/haptic_function.hpp"
#include "vibe_firmware/protocol/input_function.hpp"

namespace vibe::hardware {
namespace {

constexpr long kPeriod = 1'000'000;  // of the loop [ns]

/// Descriptor of a timer that expires with the period of the loop.
int periodicTimer() {
  const int timer = timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC);
  const itimerspec period{{0, kPeriod}, {0, kPeriod}};
  if (timer < 0 || timerfd_settime(timer, 0, &period, nullptr) != 0) {
    throw std::runtime_error(std::string("no timer: ") + std::strerror(errno));
  }
  return timer;
}

/// Function is vibe_firmware::HapticFunction or InputFunction.
template <class Function, class Config>
class FirmwareDevice : public UsbDevice {
 public:
  explicit FirmwareDevice(std::string serial) : serial_(std::move(serial)) {}
  ~FirmwareDevice() override { close(timer_); }
  FirmwareDevice(const FirmwareDevice&) = delete;
  FirmwareDevice& operator=(const FirmwareDevice&) = delete;

  int control(const vibe_firmware::UsbSetup& setup, const std::uint8_t* data, std::uint8_t* response,
              std::size_t capacity) override {
    return control_.handle(setup, data, response, capacity);
  }

  void reset() override { control_.reset(); }

  int descriptor() const override { return timer_; }

  void service(const ReportSink& sink) override {
    std::uint64_t due = 0;  // ticks; more than one if this process had to wait
    if (read(timer_, &due, sizeof due) != sizeof due) return;
    std::uint8_t bytes[vibe_firmware::kInputReportSize];
    for (; due > 0; --due) {
      function_.tick(scriptedHand(tick_++));
      if (function_.nextReport(bytes)) sink(bytes, sizeof bytes);
    }
  }

 private:
  const std::string serial_;
  Function function_{Config{}, serial_.c_str()};
  vibe_firmware::ControlEndpoint control_{function_};
  int timer_ = periodicTimer();
  std::uint32_t tick_ = 0;
};

}  // namespace

std::unique_ptr<UsbDevice> makeHapticDevice(const std::string& serial) {
  return std::make_unique<FirmwareDevice<vibe_firmware::HapticFunction, vibe_firmware::HapticConfig>>(serial);
}

std::unique_ptr<UsbDevice> makeInputDevice(const std::string& serial) {
  return std::make_unique<FirmwareDevice<vibe_firmware::InputFunction, vibe_firmware::InputConfig>>(serial);
}

}  // namespace vibe::hardware
