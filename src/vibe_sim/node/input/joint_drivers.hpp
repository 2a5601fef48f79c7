#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "input/input_sample.hpp"

namespace vibe::sim {

/// A sender that does not move for this long rests; one that is silent for as long begins anew [ns].
constexpr std::int64_t kRest = 300'000'000;

/// Decides which of several nodes moves the joints of a channel, whatever their topics are, so that one that only
/// repeats what it has said does not pull the joints back, and two that move at once do not pull to and fro:
///   - a first message takes over, and so does a sender that begins to move: by more than 1 mm or 1 degree after a
///   rest;
///   - one that goes on moving takes over from one that rests;
///   - all else of others than the present driver is ignored.
/// A function of samples only. Samples without a sender are of one and the same.
class JointDrivers {
 public:
  /// @param hand  the joints at present [m], [rad]: who asks for no other place does not begin to move
  /// @param[out] sentence  set if the sample is ignored although its sender moves, and if it is in another frame than
  ///                       that of its sender just before
  /// @return whether the sample is obeyed
  bool obeys(const InputSample& sample, const JointArray& hand, std::string& sentence);

 private:
  struct Driver {
    const SampleSender* sender;
    InputSample anchor;  // the last that was not a repetition
    std::int64_t heard;
    std::optional<std::int64_t> moved;  // empty: not since its first message
  };
  std::vector<Driver> heard_;             // those that are not silent
  const SampleSender* driver_ = nullptr;  // the one obeyed last

  const Driver* movingDriver(std::int64_t stamp) const;
};

}  // namespace vibe::sim
