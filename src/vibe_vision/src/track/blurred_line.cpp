#include "track/blurred_line.hpp"

#include <array>
#include <cmath>

namespace vibe::vision {
namespace {

constexpr double kStepReach = 6;  // standard deviations after which a step is over

/// Adds a step from 0 to `sign` at distance 0, blurred. The area of a pixel has a negative fourth cumulant, -w^4 / 120,
/// the first term of the Edgeworth series (Kendall's Advanced Theory of Statistics, volume 1, 6.18).
void addStep(double distance, double sign, double deviation, double cumulant, std::array<double, 4>& sum) {
  const double z = distance / deviation;
  if (z <= -kStepReach) return;
  if (z >= kStepReach) {
    sum[0] += sign * distance;
    sum[1] += sign;
    return;
  }
  const double value = 0.5 * std::erfc(-z * M_SQRT1_2);
  const double slope = std::exp(-z * z / 2) / std::sqrt(2 * M_PI) / deviation;
  const double c = cumulant / 24 / std::pow(deviation, 2) * slope;
  sum[0] += sign * (distance * value + deviation * deviation * slope + c * (z * z - 1));
  sum[1] += sign * (value - c / deviation * (z * z * z - 3 * z));
  sum[2] += sign * (slope + c / (deviation * deviation) * (z * z * z * z - 6 * z * z + 3));
  sum[3] -= sign * z / deviation * slope;
}

}  // namespace

BlurredLine::BlurredLine(const std::vector<Interval>& black, double period, double min_variance, double pixel_variance)
    : period_(static_cast<float>(period)),
      inverse_period_(period > 0 ? static_cast<float>(1 / period) : 0.0F),
      first_step_(stepOf(static_cast<float>(min_variance))),
      last_step_(stepOf(kMaxVariance)) {
  const double reach = kStepReach * std::sqrt(kMaxVariance);
  const double begin = period > 0 ? 0 : std::floor(black.front().begin - reach);
  const double end = period > 0 ? period : std::ceil(black.back().end + reach);
  begin_ = static_cast<float>(begin);
  length_ = static_cast<float>(end - begin);
  margin_ = period > 0 ? kMargin * static_cast<int>(kPerPixel) : 0;
  size_ = static_cast<std::size_t>(std::ceil((end - begin) * kPerPixel)) + 2 + 2 * static_cast<std::size_t>(margin_);
  last_ = static_cast<int>(size_) - 1;
  if (period > 0)
    for (const Interval& interval : black) mean_ += static_cast<float>((interval.end - interval.begin) / period);
  entries_.reserve(size_ * static_cast<std::size_t>(last_step_ - first_step_ + 1));
  for (std::int32_t step = first_step_; step <= last_step_; ++step)
    for (int i = 0; i <= last_; ++i)
      entries_.push_back(
          entryAt(black, begin + static_cast<double>(i - margin_) / kPerPixel, varianceOf(step), pixel_variance));
}

BlurredLine::Entry BlurredLine::entryAt(const std::vector<Interval>& black, double x, double variance,
                                        double pixel_variance) const {
  const double deviation = std::sqrt(variance);
  const double cumulant = variance > 1.5 * pixel_variance ? -1.2 * pixel_variance * pixel_variance : 0;
  // the same for all variances: integrals of different tables must go together
  const double copies = period_ > 0 ? std::ceil((kStepReach * std::sqrt(kMaxVariance) + kMargin) / period_) + 1 : 0;
  std::array<double, 4> sum{};
  for (double copy = -copies; copy <= copies; ++copy)
    for (const Interval& interval : black) {
      addStep(x - interval.begin - copy * period_, 1, deviation, cumulant, sum);
      addStep(x - interval.end - copy * period_, -1, deviation, cumulant, sum);
    }
  return {static_cast<float>(sum[0] - static_cast<double>(mean_) * x), static_cast<float>(sum[1]),
          static_cast<float>(sum[2]), static_cast<float>(sum[3])};
}

}  // namespace vibe::vision
