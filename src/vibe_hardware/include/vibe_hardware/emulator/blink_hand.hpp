#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "vibe_hardware/emulator/hand.hpp"

namespace vibe::hardware {

/// When a hand blinks.
struct BlinkSetup {
  int count = 1000;
  std::uint64_t seed = 1;
  double begin = 3;        ///< first blink, at least this long after the end of the other hand [s]
  double shortest = 0.25;  ///< between two blinks, longer than the latency to be measured [s]
  double longest = 0.5;    ///< [s]
  double step = 0.03;      ///< of tip_left_right [rad]
};

/// Another hand whose tip_left_right jumps to and fro at random times, like an LED that blinks: for measuring how long
/// the jump takes to become visible. The times are continuous, so that their phase against every clock of the system is
/// uniform.
class BlinkHand : public Hand {
 public:
  /// @param other  null: a hand that holds still at 0
  /// @throws Error if the other hand never ends, or the times make no sense
  BlinkHand(const BlinkSetup& setup, std::shared_ptr<const Hand> other);

  HandSample at(double time) const override;
  double duration() const override;

  /// Times of the jumps, ascending [s]. The first one goes up, the next down.
  const std::vector<double>& blinks() const { return blinks_; }

 private:
  std::shared_ptr<const Hand> other_;
  double step_;
  std::vector<double> blinks_;
};

}  // namespace vibe::hardware
