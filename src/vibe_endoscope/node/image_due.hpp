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
  bool isDue(const ros::Time& stamp);

 private:
  double period_;  ///< [s]
  ros::Time last_, next_;
  bool any_ = false;
};

}  // namespace vibe::endoscope
