#pragma once

namespace vibe {

/// Completed fraction of a movement at a fraction s in [0, 1] of its time: 10 s^3 - 15 s^4 + 6 s^5. This is the
/// straight movement with the least mean squared jerk between two rest positions, and close to human reaching: Flash &
/// Hogan 1985, J Neurosci 5(7):1688. The peak speed is 15/8 of the mean speed, at half time.
inline double minimumJerk(double s) {
  if (s <= 0) return 0;
  if (s >= 1) return 1;
  return s * s * s * (10 + s * (-15 + 6 * s));
}

}  // namespace vibe
