#pragma once

#include <atomic>
#include <cstdint>
#include <type_traits>

#include "vibe_firmware/hal/board.hpp"
#include "vibe_firmware/protocol/control_endpoint.hpp"

namespace vibe_firmware {

/// Tells which ticks of the control loop came late.
class TickMonitor {
 public:
  static constexpr std::uint32_t kLatest = 1100;  ///< after the last tick: 10 % more than the period [us]

  /// @param time_us  of this tick; wraps
  bool isLate(std::uint32_t time_us) {
    const bool late = started_ && time_us - last_us_ > kLatest;
    started_ = true;
    last_us_ = time_us;
    return late;
  }

 private:
  std::uint32_t last_us_ = 0;
  bool started_ = false;
};

/// The firmware of a device on any board. A port makes one, calls tick() from its 1 kHz interrupt and poll() from its
/// main loop.
/// @tparam Function  HapticFunction or InputFunction
template <typename Function>
class Application final : private ControlHandler {
 public:
  /// Board, link and function have to outlive it.
  Application(Board& board, UsbLink& link, Function& function)
      : board_(board), link_(link), function_(function), endpoint_(function) {}

  /// Reads the board, runs one control step and writes the torque.
  void tick() {
    const HapticSample sample = board_.sample();
    if (monitor_.isLate(sample.time_us)) function_.countLateTick();
    if constexpr (std::is_void_v<decltype(function_.tick(sample))>)
      function_.tick(sample);
    else
      board_.writeTorque(function_.tick(sample));
    tick_has_run_ = true;
  }

  /// Answers the host, sends the report that is due and restarts the watchdog if a tick has run since the last call:
  /// a stopped main loop and a stopped interrupt both end in a reset.
  void poll() {
    link_.poll(*this);
    std::uint8_t report[kInputReportSize];
    if (function_.nextReport(report) && endpoint_.configured() && !endpoint_.halted())
      link_.sendReport(report, sizeof report);
    if (tick_has_run_.exchange(false)) board_.feedWatchdog();
  }

 private:
  int handleControl(const UsbSetup& setup, const std::uint8_t* data, std::uint8_t* response) override {
    return endpoint_.handle(setup, data, response, kMaxData);
  }
  void handleBusReset() override {
    endpoint_.reset();
    function_.hostGone();
  }
  void handleSuspend() override { function_.hostGone(); }

  Board& board_;
  UsbLink& link_;
  Function& function_;
  ControlEndpoint endpoint_;
  TickMonitor monitor_;
  std::atomic<bool> tick_has_run_{false};
};

}  // namespace vibe_firmware
