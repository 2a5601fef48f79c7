#pragma once
#include <algorithm>
#include <cmath>

namespace vibe::vision {

/// Motion of a hand: reaches of minimum jerk from -20 mm to 20 mm and back with a peak of 0.28 m/s, 0.3 s of rest
/// between them, and a tremor of 0.1 mm at 9 Hz all the time.
struct Reach {
  double begin = 0, phase = 0;  ///< of the reaches [s], of the tremor [rad]

  double operator()(double time) const {
    constexpr double kLength = 0.04, kPeak = 0.28, kRest = 0.3, kTremor = 1e-4, kTremorRate = 9;
    constexpr double kDuration = 1.875 * kLength / kPeak, kPeriod = 2 * (kDuration + kRest);
    const double t = std::fmod(time + begin, kPeriod);
    const auto part = [](double x) {
      const double s = std::clamp(x, 0.0, 1.0);
      return s * s * s * (10 + s * (-15 + 6 * s));
    };
    const double reach = part(t / kDuration) - part((t - kDuration - kRest) / kDuration);
    return -kLength / 2 + kLength * reach + kTremor * std::sin(2 * M_PI * kTremorRate * time + phase);
  }
};

}  // namespace vibe::vision
