#include "vibe_hardware/gamepad/pad_link.hpp"

namespace vibe::hardware {
namespace {

constexpr double kRetryPeriod = 0.5;  // [s]

}  // namespace

std::string PadLink::poll(double now) {
  if (!pad_) return look(now);
  if (pad_->update(now)) return "";
  const PadInfo info = pad_->info();
  pad_.reset();
  told_ = true;
  last_try_ = now;
  const std::string what = info.is_recording ? "The recording of the gamepad '" + info.name + "' has ended"
                                             : "The gamepad '" + info.name + "' is gone";
  return what + ": its buttons are released and the joints stay where they are." +
         (info.is_recording ? "" : " Waiting for it.");
}

std::string PadLink::look(double now) {
  if (now - last_try_ < kRetryPeriod) return "";
  last_try_ = now;
  std::string why;
  pad_ = open_(why);
  if (pad_) {
    ++connections_;
    told_ = false;
    return "Found the gamepad '" + pad_->info().name + "' at " + pad_->info().path + ".";
  }
  if (told_) return "";
  told_ = true;
  return why + " Waiting for it.";
}

}  // namespace vibe::hardware
