#pragma once

#include <string>
#include <vector>

namespace vibe::vision {

/// The numbers that decide in a tracker: when it searches, what it takes for the marker, when it learns and doubts.
/// They belong to the method and not to a rig, whose numbers have keys in its configuration. Each row of
/// tracker_numbers.inl is a member here, a row of docs/vision.md, and something that `vibe_tracker_numbers` shifts to
/// see what moves.
struct TrackerPolicy {
/// No member.
#define VIBE_POLICY_SECTION(title)
/// A number with a unit, or a ratio.
#define VIBE_REAL(name, value, unit, meaning, reason) double name = value;
/// A count.
#define VIBE_COUNT(name, value, meaning, reason) int name = value;
#include "vibe_vision/track/tracker_numbers.inl"
#undef VIBE_POLICY_SECTION
#undef VIBE_REAL
#undef VIBE_COUNT
};

/// One number of the policy, for tables and for what shifts it.
struct TrackerNumber {
  std::string section;                    ///< what it decides about
  std::string name;                       ///< of the member of TrackerPolicy
  std::string unit;                       ///< empty for a ratio or a count
  std::string meaning;                    ///< what it is
  std::string reason;                     ///< why it has its default
  double TrackerPolicy::*real = nullptr;  ///< the member, in `unit`; null if it is a count
  int TrackerPolicy::*count = nullptr;    ///< the member, if it is a count

  /// Its value in a policy.
  double of(const TrackerPolicy& policy) const { return real != nullptr ? policy.*real : policy.*count; }
  /// A count becomes the nearest whole number, at least 1 above or below where it would stay the same, never below 1.
  void scale(TrackerPolicy& policy, double factor) const;
};

/// All of them, in the order of the table.
const std::vector<TrackerNumber>& trackerNumbers();

}  // namespace vibe::vision
