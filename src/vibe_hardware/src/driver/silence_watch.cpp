#include "vibe_hardware/driver/silence_watch.hpp"

namespace vibe::hardware {

bool SilenceWatch::arrived(double now) {
  const bool ends_silence = told_;
  last_ = now;
  watching_ = true;
  told_ = false;
  return ends_silence;
}

bool SilenceWatch::expired(double now) {
  if (!watching_ || now - last_ < kLimit) return false;
  watching_ = false;
  told_ = true;
  return true;
}

}  // namespace vibe::hardware
