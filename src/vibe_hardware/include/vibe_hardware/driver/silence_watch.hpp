#pragma once
#include "vibe_hardware/driver/device_driver.hpp"

namespace vibe::hardware {

/// Tells that the samples of a device have stopped, to a thread that does not wait for the device: a request that is
/// not answered keeps the driver's own thread for seconds. Not thread-safe. Times: host clock [s].
class SilenceWatch {
 public:
  /// Without a sample, after which the device counts as silent. Longer than the driver's own limit, so that the driver
  /// speaks first if it can [s].
  static constexpr double kLimit = DeviceDriver::kSilence + 0.02;

  /// A sample has come. @return whether it ends a silence that has been told
  bool arrived(double now);
  /// The driver itself has said that the device is gone or silent.
  void stop() { watching_ = told_ = false; }
  /// Whether the device has become silent; true once for each silence.
  bool expired(double now);

 private:
  double last_ = 0;  // arrival of the last sample
  bool watching_ = false;
  bool told_ = false;
};

}  // namespace vibe::hardware
