#pragma once

#include <array>
#include <cstdint>

#include "vibe_core/contact/tool_model.hpp"
#include "vibe_core/input/step_input.hpp"

namespace vibe::sim {

using JointArray = std::array<double, kJointCount>;

/// A motion of some joints from where they are to a goal, all in the same time: the path of least jerk from rest to
/// rest (Flash and Hogan 1985), as fast as the limits of the slowest joint allow. A function of time only.
class JointMove {
 public:
  /// @param start   of all joints [m], [rad]
  /// @param goal    read from joint `first` to `first + count - 1`, the ones that move; clamped to the limits
  /// @param limits  of position and velocity
  /// @param begin   stamp [ns]
  JointMove(const JointArray& start, const JointArray& goal, int first, int count,
            const std::array<JointLimits, kJointCount>& limits, std::int64_t begin);

  /// Sets the joints that move to their place on the path; before the begin that is the start, after the end the goal.
  void apply(std::int64_t stamp, JointArray& joints) const;
  std::int64_t end() const { return begin_ + duration_; }  ///< stamp [ns]

 private:
  JointArray start_, way_{};
  int first_, count_;
  std::int64_t begin_, duration_ = 0;
};

}  // namespace vibe::sim
