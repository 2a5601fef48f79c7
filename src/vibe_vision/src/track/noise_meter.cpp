#include "track/noise_meter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace vibe::vision {
namespace {

// Design choices.
constexpr int kAcross = 16, kDown = 12, kWidth = 34, kHeight = 8;  // tiles, and their pixels
constexpr int kFirstPictures = 4, kEveryPicture = 16;              // pictures that are measured
constexpr double kNoiseMemory = 0.8;
constexpr double kDarkTile = 4, kBrightTile = 245;           // mean grey values of tiles that are cut off
constexpr double kNoticeableNoise = 1.3, kWrongNoise = 1.6;  // ratio of variances
// Of a normal variable with unit variance: mean of |x|; of its second difference: standard deviation.
const double kMeanDifference = std::sqrt(2 / M_PI) * std::sqrt(6.0);

}  // namespace

/// Of the variance in a tile to the stated one; negative where a tile tells nothing.
double NoiseMeter::ratioOf(const ImageView& image, int left, int top) const {
  int differences = 0, values = 0;
  for (int y = top; y < top + kHeight; ++y) {
    const std::uint8_t* p = image.row(y) + left;
    for (int x = 1; x + 1 < kWidth; ++x) {
      differences += std::abs(p[x - 1] - 2 * p[x] + p[x + 1]);
      values += p[x];
    }
  }
  constexpr double kCount = (kWidth - 2) * kHeight;
  const double mean = values / kCount, deviation = differences / kCount / kMeanDifference;
  if (mean < kDarkTile || mean > kBrightTile) return -1;
  return deviation * deviation / (stated_.gain * mean + stated_.read * stated_.read);
}

void NoiseMeter::look(const ImageView& image) {
  const bool now = frames_ < kFirstPictures || frames_ % kEveryPicture == 0;
  ++frames_;
  if (!now || image.width < kWidth || image.height < kHeight) return;
  std::array<double, kAcross * kDown> ratios{};
  int count = 0;
  for (int j = 0; j < kDown; ++j)
    for (int i = 0; i < kAcross; ++i) {
      const double ratio =
          ratioOf(image, (image.width - kWidth) * i / (kAcross - 1), (image.height - kHeight) * j / (kDown - 1));
      if (ratio >= 0) ratios[static_cast<std::size_t>(count++)] = ratio;
    }
  if (count == 0) return;
  const auto quarter = ratios.begin() + count / 4;
  std::nth_element(ratios.begin(), quarter, ratios.begin() + count);
  ratio_ = ratio_ == 0 ? *quarter : kNoiseMemory * ratio_ + (1 - kNoiseMemory) * *quarter;
}

PixelNoise NoiseMeter::noise() const {
  const double more = ratio_ > kNoticeableNoise ? ratio_ : 1;
  return {stated_.gain * more, stated_.read * std::sqrt(more)};
}

bool NoiseMeter::doubtsStated() const {
  return ratio_ > kWrongNoise;
}

}  // namespace vibe::vision
