#include "firmware_device.hpp"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

#include <sys/timerfd.h>
#include <unistd.h>

#include "vibe_firmware/core/haptic_device.hpp"
#include "vibe_firmware/protocol/haptic_function.hpp"
#include "vibe_firmware/protocol/input_function.hpp"

namespace vibe::hardware {
namespace {

constexpr std::int32_t kTravel = 10000;      // of axis 0: counts, and ticks there
constexpr double kSwing = 5000;              // of axis 1 [counts]
constexpr double kSwingTicks = 4000;         // of a full swing
constexpr std::uint32_t kButtonTicks = 250;  // that a button is held

/// What the encoders and buttons of a device read while a hand turns axis 0 steadily there and back, swings axis 1 and
/// presses one button after the other, each for a quarter of a second. A function of the tick alone.
/// @param tick  of the 1 kHz loop, from 0
vibe_firmware::HapticSample scriptedHand(std::uint32_t tick) {
  const auto phase = static_cast<std::int32_t>(tick % (2 * kTravel));
  const std::int32_t there_and_back = phase < kTravel ? phase : 2 * kTravel - phase;
  const double angle = 2 * M_PI * tick / kSwingTicks;
  vibe_firmware::HapticSample sample;
  // the counters of the hardware have 16 bits
  sample.counter[0] = static_cast<std::uint16_t>(there_and_back);
  sample.counter[1] = static_cast<std::uint16_t>(std::lround(kSwing * std::sin(angle)));
  sample.buttons = static_cast<std::uint16_t>(1U << (tick / kButtonTicks % 16));
  sample.time_us = tick * 1000;
  return sample;
}

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
