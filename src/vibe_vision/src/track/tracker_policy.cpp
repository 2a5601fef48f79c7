#include "vibe_vision/track/tracker_policy.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::vision {

void TrackerNumber::scale(TrackerPolicy& policy, double factor) const {
  if (real != nullptr) {
    policy.*real *= factor;
    return;
  }
  const int before = policy.*count;
  const int step = std::max(1, static_cast<int>(std::lround(std::abs(factor - 1) * before)));
  policy.*count = factor < 1 ? std::max(1, before - step) : before + step;
}

const std::vector<TrackerNumber>& trackerNumbers() {
  static const std::vector<TrackerNumber> numbers = [] {
    std::vector<TrackerNumber> all;
    std::string section;
#define VIBE_POLICY_SECTION(title) section = title;
#define VIBE_REAL(name, value, unit, meaning, reason) \
  all.push_back({section, #name, unit, meaning, reason, &TrackerPolicy::name, nullptr});
#define VIBE_COUNT(name, value, meaning, reason) \
  all.push_back({section, #name, "", meaning, reason, nullptr, &TrackerPolicy::name});
#include "vibe_vision/track/tracker_numbers.inl"
#undef VIBE_POLICY_SECTION
#undef VIBE_REAL
#undef VIBE_COUNT
    return all;
  }();
  return numbers;
}

}  // namespace vibe::vision
