#pragma once

namespace vibe {

/// Share of a movement that is done at a share s in [0, 1] of its time: 10 s^3 - 15 s^4 + 6 s^5.
/// The straight movement with the least mean squared jerk between two rests, and close to how people reach:
/// Flash & Hogan 1985, J Neurosci 5(7):1688. Peak speed is 15/8 of the mean speed, at half time.
inline double minimumJerk(double s) {
  if (s <= 0) return 0;
  if (s >= 1) return 1;
  return s * s * s * (10 + s * (-15 + 6 * s));
}

}  // namespace vibe
