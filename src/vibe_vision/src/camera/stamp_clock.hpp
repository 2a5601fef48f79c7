#pragma once
#include "vibe_core/common/device_clock.hpp"
#include "vibe_vision/camera/frame_source.hpp"

namespace vibe::vision {

/// Maps stamps of a camera to Unix time. It is given the end of each exposure by the camera's clock and the host time
/// at which the first packet of the frame came. A camera sends after the exposure, so the smallest of these delays is
/// close to 0 for all of them; vibe::DeviceClock follows it and the drift. A clock that jumps is noticed.
class StampClock {
 public:
  /// @param follows_ptp  the camera says that it does
  explicit StampClock(CameraClock kind = CameraClock::Auto, bool follows_ptp = false);

  /// Unix time of the end of the exposure. @param device_end  of the exposure [s]  @param first_packet  Unix time [s]
  double map(double device_end, double first_packet);
  bool isHostTime() const { return is_host_time_; }  ///< stamps are taken as they are

 private:
  CameraClock kind_;
  bool follows_ptp_;
  DeviceClock clock_;
  bool is_host_time_ = false;
  double ahead_ = 0;  // of Unix time: 37 s for TAI
  double last_device_ = 0;

  void decide(double delay);
  bool hasJumped(double device_end, double first_packet) const;
};

}  // namespace vibe::vision
