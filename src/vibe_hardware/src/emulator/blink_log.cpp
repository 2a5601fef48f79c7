#include "vibe_hardware/emulator/blink_log.hpp"

#include <cmath>

#include "vibe_core/common/error.hpp"

namespace vibe::hardware {

BlinkLog::BlinkLog(const std::string& file, std::vector<double> blinks)
    : file_(file), out_(file), blinks_(std::move(blinks)) {
  out_ << "blink,event,report\n" << std::flush;
  if (!out_) throw Error("The blinks cannot be written to '" + file_ + "'; choose a file in a folder that exists.");
}

void BlinkLog::tick(double hand, std::int64_t wall) {
  for (; next_ < blinks_.size() && blinks_[next_] <= hand; ++next_)
    events_.push_back(wall - std::llround(1e9 * (hand - blinks_[next_])));
}

void BlinkLog::report(std::int64_t wall) {
  if (reported_ == events_.size()) return;
  for (; reported_ < events_.size(); ++reported_) out_ << reported_ << ',' << events_[reported_] << ',' << wall << '\n';
  out_.flush();
  if (!out_) throw Error("The blinks cannot be written to '" + file_ + "' any more; is the disk full?");
}

}  // namespace vibe::hardware
