#pragma once
#include <chrono>
#include <thread>

#include "vibe_core/common/step_timer.hpp"  // steadyTime()

namespace vibe::vision {

/// Unix time [s].
inline double hostTime() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

inline void sleepFor(double duration) {
  if (duration > 0) std::this_thread::sleep_for(std::chrono::duration<double>(duration));
}

}  // namespace vibe::vision
