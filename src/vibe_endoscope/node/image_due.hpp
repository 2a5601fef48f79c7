#pragma once
#include <ros/time.h>

namespace vibe::endoscope {

/// Decides for which of the states an image is drawn, so that images have a given rate in the time of their stamps.
class ImageDue {
 public:
  /// @param rate  images per second [Hz]; 0: every state
  explicit ImageDue(double rate) : period_(rate > 0 ? 1 / rate : 0) {}

  /// Whether the state with this stamp is drawn. A stamp before the last one means that time was set back; counting
  /// then starts again.
  bool isDue(const ros::Time& stamp) {
    constexpr double kSlack = 0.1;  // of a period: stamps are rounded
    const bool again = !any_ || stamp < last_;
    last_ = stamp;
    if (!again && stamp < next_ - ros::Duration(kSlack * period_)) return false;
    // counted from the due time, so that the mean rate is right even if the rate of the states is not a multiple of it
    const ros::Duration period(period_);
    next_ = again || stamp > next_ + period ? stamp + period : next_ + period;
    any_ = true;
    return true;
  }

 private:
  double period_;  ///< [s]
  ros::Time last_, next_;
  bool any_ = false;
};

}  // namespace vibe::endoscope
