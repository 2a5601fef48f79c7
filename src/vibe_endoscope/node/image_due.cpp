#include "image_due.hpp"

#include <algorithm>

namespace vibe::endoscope {

bool ImageDue::isDue(const ros::Time& stamp) {
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

}  // namespace vibe::endoscope
