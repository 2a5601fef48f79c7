#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <thread>

#include "vibe_hardware/driver/device_driver.hpp"

namespace vibe::hardware {

/// Calls a function again and again until it is destroyed.
class PollingThread {
 public:
  /// @param poll    is called all the time; it waits itself, or returns false to be called again in 5 ms
  /// @param failed  gets the sentence of an exception that `poll` lets out; polling goes on after one second
  PollingThread(std::function<bool()> poll, std::function<void(const std::string&)> failed);
  ~PollingThread();
  PollingThread(const PollingThread&) = delete;
  PollingThread& operator=(const PollingThread&) = delete;

 private:
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// Tells that the samples of a device have stopped, to a thread that does not wait for the device: a request that is
/// not answered keeps the driver's own thread for seconds. Not thread-safe. Times: host clock [s].
class SilenceWatch {
 public:
  /// Without a sample, after which the device counts as silent. Longer than the driver's own limit, so that the driver
  /// speaks first if it can [s].
  static constexpr double kLimit = DeviceDriver::kSilence + 0.02;

  /// A sample has come. @return whether it ends a silence that has been reported
  bool arrived(double now);
  /// The driver itself has said that the device is gone or silent.
  void stop() { watching_ = reported_ = false; }
  /// Whether the device has become silent; true once for each silence.
  bool expired(double now);

 private:
  double last_ = 0;  // arrival of the last sample
  bool watching_ = false;
  bool reported_ = false;
};

}  // namespace vibe::hardware
