#pragma once
#include <ros/time.h>

#include <cstdint>

namespace vibe::sim {

/// The wall clock [ns].
inline std::int64_t wallNow() {
  return static_cast<std::int64_t>(ros::WallTime::now().toNSec());
}

}  // namespace vibe::sim
