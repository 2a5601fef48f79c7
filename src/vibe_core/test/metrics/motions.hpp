#pragma once
#include <cmath>
#include <vector>

/// Speeds and positions with known measures.
namespace vibe::test {

/// Speed of a minimum-jerk reach at a share s of its time: 30 s^2 (1 - s)^2 length / duration.
inline double reachSpeed(double s, double length, double duration) {
  return s <= 0 || s >= 1 ? 0 : 30 * s * s * (1 - s) * (1 - s) * length / duration;
}

/// The same sampled from start to end.
inline std::vector<double> sampleReach(double length, double duration, double period) {
  std::vector<double> speed;
  for (int i = 0; i <= std::lround(duration / period); ++i)
    speed.push_back(reachSpeed(i * period / duration, length, duration));
  return speed;
}

/// The Gaussian bell exp(-5 t^2), t from -1 to 0.99 by 0.01 s, of the example in the program that the authors of SPARC
/// published (smoothness.py): sparc -1.41403, dimensionless jerk -335.74684, its logarithm -5.81636.
inline std::vector<double> publishedBell() {
  std::vector<double> speed;
  for (int i = 0; i < 200; ++i) speed.push_back(std::exp(-5 * std::pow(-1 + 0.01 * i, 2)));
  return speed;
}

}  // namespace vibe::test
