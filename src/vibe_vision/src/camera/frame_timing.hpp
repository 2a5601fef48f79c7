#pragma once

#include <cstdint>

#include "vibe_core/clocks/device_clock.hpp"
#include "vibe_vision/camera/frame_source.hpp"

namespace vibe::vision {

/// Makes one sequence without wraps or restarts from the frame numbers of a camera. GigE Vision 1.x counts from 1 to
/// 65535 and then from 1 again; 2.x and USB3 Vision have 64 bits.
class SequenceCounter {
 public:
  struct Step {
    std::uint64_t sequence = 0;
    std::uint64_t skipped = 0;  ///< frames between the last one and this one
  };
  /// @param id  of a complete frame
  Step advance(std::uint64_t id);
  /// The camera counts anew, e.g. after a reconnection: the next frame follows the last one without a gap.
  void restart() { is_known_ = false; }

 private:
  std::uint64_t last_id_ = 0, sequence_ = 0;
  bool is_known_ = false, has_begun_ = false;

  std::uint64_t distance(std::uint64_t id) const;
};

/// Tells frames that were left out from the stamps of the others, for drivers that tell no numbers. The period is the
/// one that was asked for, and from then on the shortest interval of the last frames: a camera that runs more slowly
/// than asked, for example in the dark, loses nothing.
class IntervalGaps {
 public:
  /// @param period  that was asked for [s]
  explicit IntervalGaps(double period) : period_(period) {}
  /// @return frames between the last stamp and this one
  std::uint64_t advance(double stamp);

 private:
  double period_, last_ = 0, shortest_ = 0;
  int intervals_ = 0;

  void learn(double interval);
};

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
