#include "track/blurred_line.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "track/arithmetic.hpp"

namespace vibe::vision {

namespace {

constexpr double kStepReach = BlurredLine::kReach;

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

using Order [[gnu::vector_size(16)]] = int;
constexpr float kVarianceStepRatio = 0.12F;  // of the variances' step to the variance that needs no more levels
constexpr int kStride = 2;                   // of the table against that of the line
constexpr float kPerPixel = BlurredLine::kPerPixel / kStride;

/// Elements n to the front, zeros behind.
Four shifted1(Four v) {
  return __builtin_shuffle(v, Four{}, Order{1, 2, 3, 4});
}
Four shifted2(Four v) {
  return __builtin_shuffle(v, Four{}, Order{2, 3, 4, 4});
}
Four shifted3(Four v) {
  return __builtin_shuffle(v, Four{}, Order{3, 4, 4, 4});
}

/// An entry of a BlurredLine, taken d further and with more variance; see BlurredLine::at().
struct Shift {
  int steps;
  Four first, second, third;
  Shift(float distance, float more_variance) {
    const float place = distance * BlurredLine::kPerPixel;
    steps = static_cast<int>(std::floor(place + 0.5F));
    const float d = (place - static_cast<float>(steps)) / BlurredLine::kPerPixel;
    const float s = 0.5F * (more_variance + d * d);
    first = Four{d, d, d, 0};
    second = Four{s, s, 0, 0};
    third = Four{d * (s + more_variance) / 3, 0, 0, 0};
  }
  Four of(Four e) const { return e + first * shifted1(e) + second * shifted2(e) + third * shifted3(e); }
};

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

/// Chords of the parabola have the same mean as it has if they are all shifted a little.
MotionParts::MotionParts(float bend) {
  if (bend == 0) return;
  count = 4;
  for (int k = 0; k <= count; ++k) {
    const float time = static_cast<float>(k) / 2 - 1;  // from -1 to 1
    place[static_cast<std::size_t>(k)] = time + 2 * bend * (time * time - 3.0F / 8);
  }
}

MovingLine::MovingLine(const BlurredLine& line, int levels)
    : line_(line),
      max_levels_(levels),
      size_(static_cast<std::size_t>(line.length() * kPerPixel) + 2),
      table_(size_ * static_cast<std::size_t>(levels) * kFourSize) {}

void MovingLine::compose(float low, float high, float half_motion, const MotionParts& parts) {
  low_ = low;
  const float range = std::max(high - low, 1e-3F);
  levels_ = std::clamp(1 + static_cast<int>(std::ceil(range / (kVarianceStepRatio * low))), 2, max_levels_);
  step_ = range / static_cast<float>(levels_ - 1);
  half_motion_ = std::min(half_motion, kMaxHalfMotion);
  const float nothing = std::max(line_.margin(high) - half_motion_ * 1.5F, 0.0F) * kPerPixel;
  first_ = static_cast<std::size_t>(nothing);
  last_ = size_ - 1 - first_;
  for (int level = 0; level < levels_; ++level)
    composeLevel(low_ + static_cast<float>(level) * step_, parts,
                 table_.data() + static_cast<std::size_t>(level) * size_ * kFourSize);
}

void MovingLine::composeLevel(float variance, const MotionParts& parts, float* table) const {
  const BlurredLine::Level level = line_.levelOf(variance);
  const float more = variance - level.variance, mean = line_.mean();
  float before = 0, base = 1;
  for (int k = 0; k <= parts.count; ++k) {
    const float length = k < parts.count ? half_motion_ * (parts.place[k + 1] - parts.place[k]) : 0;
    const float weight = k < parts.count ? 1 / (length * static_cast<float>(parts.count)) : 0, w = weight - before;
    const Shift shift(-half_motion_ * parts.place[k], more);
    const Four factor{w, w, w, 0};
    base -= w * shift.first[0];  // integrals are without the mean
    const Four rest{k == parts.count ? mean * base : 0, 0, 0, 0};
    const auto add = [&](std::size_t i, const float* entry) {
      const Four sum = k == 0 ? Four{} : loadFour(table + i * kFourSize);
      store(table + i * kFourSize, sum + shift.of(loadFour(entry)) * factor + rest);
    };
    const int begin = static_cast<int>(first_) * kStride + shift.steps;
    const int end = static_cast<int>(last_) * kStride + shift.steps;
    if (line_.has(begin) && line_.has(end)) {
      const float* entry = line_.entry(level, begin);
      for (std::size_t i = first_; i <= last_; ++i, entry += kStride * kFourSize) add(i, entry);
    } else {
      for (std::size_t i = first_; i <= last_; ++i)
        add(i, line_.entry(level, static_cast<int>(i) * kStride + shift.steps));
    }
    before = weight;
  }
}

VIBE_LANES void MovingLine::look(const Places& places, std::size_t count, const Result& result) const {
  const float first = static_cast<float>(first_), last = static_cast<float>(last_), per_step = 1 / step_,
              top = static_cast<float>(levels_ - 1);
  const float square = half_motion_ * half_motion_, low = low_, step = step_, stride = static_cast<float>(size_);
  const BlurredLine::Wrap wrap = line_.wrap();
  alignas(16) float d[kPart], s[kPart];
  alignas(16) int index[kPart];
  const float* __restrict x = places.x, * __restrict variance = places.variance, * __restrict half = places.half_motion;
  for (std::size_t i = 0; i < count; ++i) {
    float place = wrap.at(x[i]) * kPerPixel;
    place = place < first ? first : place;
    place = place > last ? last : place;
    // A longer motion is a blur with more variance.
    const float all = variance[i] + (half[i] * half[i] - square) * (1.0F / 3);
    float level = (all - low) * per_step + 0.5F;
    level = level < 0 ? 0 : level;
    level = level > top ? top : level;
    const auto l = static_cast<float>(static_cast<int>(level)), p = static_cast<float>(static_cast<int>(place + 0.5F));
    index[i] = static_cast<int>(l * stride + p);
    d[i] = (place - p) / kPerPixel;
    s[i] = 0.5F * (all - low - l * step + d[i] * d[i]);
  }
  for (std::size_t i = 0; i < count; i += kFourSize) {
    Four e[kFourSize];
    for (std::size_t k = 0; k < kFourSize; ++k) {
      const Four entry = loadFour(table_.data() + static_cast<std::size_t>(index[i + k]) * kFourSize);
      e[k] = entry + d[i + k] * shifted1(entry) + s[i + k] * shifted2(entry);
    }
    const Four ab = __builtin_shuffle(e[0], e[1], Order{0, 4, 1, 5});
    const Four cd = __builtin_shuffle(e[2], e[3], Order{0, 4, 1, 5});
    const Four bends = __builtin_shuffle(__builtin_shuffle(e[0], e[1], Order{2, 6, 3, 7}),
                                         __builtin_shuffle(e[2], e[3], Order{2, 6, 3, 7}), Order{0, 1, 4, 5});
    store(result.value + i, __builtin_shuffle(ab, cd, Order{0, 1, 4, 5}));
    store(result.slope + i, __builtin_shuffle(ab, cd, Order{2, 3, 6, 7}));
    store(result.bend + i, bends);
  }
}

}  // namespace vibe::vision
