#include "camera/sequence_counter.hpp"

namespace vibe::vision {
namespace {

constexpr std::uint64_t kShortIds = 65535;  // 0 is no frame number

}  // namespace

SequenceCounter::Step SequenceCounter::advance(std::uint64_t id) {
  Step step;
  if (!has_begun_) {
    sequence_ = id;
  } else {
    const std::uint64_t steps = is_known_ ? distance(id) : 1;
    sequence_ += steps;
    step.skipped = steps - 1;
  }
  has_begun_ = is_known_ = true;
  last_id_ = id;
  step.sequence = sequence_;
  return step;
}

std::uint64_t SequenceCounter::distance(std::uint64_t id) const {
  if (id > last_id_) return id - last_id_;
  const bool has_wrapped = last_id_ <= kShortIds && last_id_ - id > kShortIds / 2;
  return has_wrapped ? id + kShortIds - last_id_ : 1;  // 1: the camera has begun to count anew
}

}  // namespace vibe::vision
