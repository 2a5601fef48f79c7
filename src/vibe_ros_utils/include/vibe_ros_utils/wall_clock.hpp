#pragma once
#include <ros/time.h>

#include <cstdint>

namespace vibe::ros_utils {

/// The wall clock [ns].
inline std::int64_t wallTime() {
  return static_cast<std::int64_t>(ros::WallTime::now().toNSec());
}

}  // namespace vibe::ros_utils
