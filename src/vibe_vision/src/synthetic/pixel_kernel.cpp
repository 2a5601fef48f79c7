#include "synthetic/pixel_kernel.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::vision {

PixelKernel::PixelKernel(double sigma, int samples)
    : samples_(samples), margin_(std::max(1, static_cast<int>(std::ceil(4.5 * sigma)))) {
  const int count = (2 * margin_ + 1) * samples_;
  const double deviation = std::max(sigma * samples_, 0.05);
  std::vector<double> weights(static_cast<std::size_t>(count), 0.0);
  double sum = 0;
  for (int i = 0; i < count; ++i)
    for (int s = 0; s < samples_; ++s) {  // samples of the pixel itself
      const double distance = (i - margin_ * samples_ - s) / deviation;
      weights[static_cast<std::size_t>(i)] += std::exp(-0.5 * distance * distance);
    }
  for (const double w : weights) sum += w;
  std::vector<double> lattice(static_cast<std::size_t>(2 * margin_ + 3), 0.0);
  for (int i = 0; i < count; ++i) {
    const double w = weights[static_cast<std::size_t>(i)] / sum;
    weights_.push_back(static_cast<float>(w));
    const double place = (i + 0.5) / samples_ + 0.5;  // of the sample, counted from lattice point -margin - 1
    const auto left = static_cast<std::size_t>(place);
    lattice[left] += w * (1 - (place - static_cast<double>(left)));
    lattice[left + 1] += w * (place - static_cast<double>(left));
  }
  lattice_.assign(lattice.begin(), lattice.end());
}

template <int kSamples>
void PixelKernel::sumAlongRow(const float* samples, int count, float* pixels) const {
  const auto taps = static_cast<int>(weights_.size());
  for (int i = 0; i < count; ++i) {
    const float* from = samples + i * kSamples;
    float sums[kSamples] = {};
    for (int k = 0; k < taps; k += kSamples)
      for (int s = 0; s < kSamples; ++s) sums[s] += weights_[static_cast<std::size_t>(k + s)] * from[k + s];
    pixels[i] = 0;
    for (const float sum : sums) pixels[i] += sum;
  }
}

void PixelKernel::alongRow(const float* samples, int count, float* pixels) const {
  if (samples_ == 2)
    sumAlongRow<2>(samples, count, pixels);
  else
    sumAlongRow<4>(samples, count, pixels);
}

}  // namespace vibe::vision
