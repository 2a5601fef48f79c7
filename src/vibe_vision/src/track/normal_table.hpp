#pragma once
#include <array>

namespace vibe::vision {

/// The standard normal distribution as a table: its integral, itself and its density, to 1e-6. A step blurred by a
/// Gaussian of deviation s is value(x / s); the integral of that over x is s * integral(x / s).
class NormalTable {
 public:
  struct Entry {
    float integral, value, density;
  };
  static const NormalTable& instance();

  Entry at(float x) const {
    if (x <= -kReach) return {0, 0, 0};
    if (x >= kReach) return {x, 1, 0};
    const int i = static_cast<int>((x + kReach) * kPerUnit + 0.5F);
    const Entry& e = entries_[static_cast<std::size_t>(i)];
    const float centre = static_cast<float>(i) / kPerUnit - kReach, d = x - centre;
    const float slope = -centre * e.density, bend = (centre * centre - 1) * e.density;
    return {e.integral + d * (e.value + d * (0.5F * e.density + d * slope / 6)),
            e.value + d * (e.density + d * (0.5F * slope + d * bend / 6)), e.density + d * (slope + 0.5F * d * bend)};
  }

 private:
  NormalTable();
  static constexpr float kReach = 5, kPerUnit = 16;
  std::array<Entry, 161> entries_{};
};

}  // namespace vibe::vision
