#include "vibe_core/metrics/spectral_arc_length.hpp"

#include <algorithm>
#include <cmath>

#include "common/elementary.hpp"
#include "metrics/fourier_transform.hpp"

namespace vibe {
namespace {

constexpr double kHighestFrequency = 10;  // [Hz]; these three: the cited paper
constexpr double kThreshold = 0.05;       // of the normalised magnitude
constexpr int kPadding = 16;              // times the next power of two: four levels

int paddedLength(std::size_t samples) {
  std::size_t length = 1;
  while (length < samples) length *= 2;
  return static_cast<int>(length) * kPadding;
}

/// Greatest index with at least this magnitude; the first frequency has one, as the speed is never negative.
int lastAtLeast(const std::vector<double>& magnitude, int count, double min) {
  int last = count - 1;
  while (last > 0 && magnitude[last] < min) --last;
  return last;
}

}  // namespace

struct SpectralArcLength::Tables {
  FourierTransform fourier;
  std::vector<double> padded;
};

SpectralArcLength::SpectralArcLength(int longest) : tables_(std::make_unique<Tables>()) {
  // the transform makes its tables when it meets a length for the first time: here, not in a step
  for (int samples = std::max(longest, 2); samples > 1; samples = (samples + 1) / 2)
    transform(std::vector<double>(samples, 0.0));
}

SpectralArcLength::~SpectralArcLength() = default;

int SpectralArcLength::transform(const std::vector<double>& speed) {
  const int length = paddedLength(speed.size()), half = length / 2 + 1;
  Tables& t = *tables_;
  t.padded.assign(length, 0.0);
  std::copy(speed.begin(), speed.end(), t.padded.begin());
  magnitude_.resize(half);
  t.fourier.magnitudes(t.padded, magnitude_);
  return length;
}

std::optional<double> SpectralArcLength::of(const std::vector<double>& speed, double period) {
  if (speed.size() < 2 || !(period > 0)) return std::nullopt;
  const int length = transform(speed);
  const double max = *std::max_element(magnitude_.begin(), magnitude_.end());
  if (!(max > 0) || !std::isfinite(max)) return std::nullopt;
  // the last frequency of the band, with room for the rounding of a frequency that falls on its edge
  const int band = std::min(static_cast<int>(kHighestFrequency * length * period * (1 + 1e-12)), length / 2) + 1;
  const int last = lastAtLeast(magnitude_, band, kThreshold * max);
  if (last == 0) return std::nullopt;
  double sum = 0;
  for (int k = 0; k < last; ++k) sum += math::hypot(1.0 / last, (magnitude_[k + 1] - magnitude_[k]) / max);
  return -sum;
}

std::optional<double> spectralArcLength(const std::vector<double>& speed, double period) {
  return SpectralArcLength(static_cast<int>(std::max<std::size_t>(speed.size(), 2))).of(speed, period);
}

}  // namespace vibe
