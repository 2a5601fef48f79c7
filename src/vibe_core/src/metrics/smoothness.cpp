#include "vibe_core/metrics/smoothness.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>
#include <vector>

#include "arithmetic/elementary.hpp"

namespace vibe {

namespace {
constexpr double kFall = 0.2;  // share of a peak by which the speed rises and falls around it
}  // namespace

void PeakCounter::add(double speed) {
  if (rising_) {
    extreme_ = std::max(extreme_, speed);
    if (extreme_ < threshold_ || speed > (1 - kFall) * extreme_) return;
    ++count_;
  } else {
    extreme_ = std::min(extreme_, speed);
    if (extreme_ > (1 - kFall) * speed) return;
  }
  rising_ = !rising_;
  extreme_ = speed;
}

void PeakCounter::finish() {
  if (rising_ && extreme_ >= threshold_) ++count_;
  rising_ = true;
  extreme_ = 0;
}

/// Discrete Fourier transforms of real records whose lengths are powers of two (Cooley & Tukey 1965, "An algorithm for
/// the machine calculation of complex Fourier series"). Eigen's takes its sines and cosines from the C library.
class FourierTransform {
 public:
  /// The magnitudes at the frequencies 0 to half the sampling rate.
  /// @param record     a power of two of samples, at least 4
  /// @param magnitude  half as many and one; overwritten
  void magnitudes(const std::vector<double>& record, std::vector<double>& magnitude) {
    const std::size_t half = record.size() / 2;
    if (root_.size() < half) makeRoots(half);
    stride_ = 2 * root_.size() / record.size();
    // the even samples are the real parts, the odd ones the imaginary parts
    point_.resize(half);
    for (std::size_t i = 0; i < half; ++i) point_[i] = {record[2 * i], record[2 * i + 1]};
    reverseBits();
    for (std::size_t length = 2; length <= half; length *= 2) combine(length);
    for (std::size_t k = 0; k <= half; ++k) {
      const Complex a = point_[k % half], b = std::conj(point_[(half - k) % half]);
      const Complex even = 0.5 * (a + b), odd = product({0, -0.5}, a - b);
      const Complex all = even + product(k < half ? root_[k * stride_] : Complex(-1), odd);
      magnitude[k] = math::hypot(all.real(), all.imag());
    }
  }

 private:
  using Complex = std::complex<double>;

  static Complex product(const Complex& a, const Complex& b) {
    return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
  }

  /// The first half of the roots of unity of twice this order, clockwise.
  void makeRoots(std::size_t half) {
    root_.resize(half);
    for (std::size_t k = 0; k < half; ++k) {
      const double angle = M_PI * static_cast<double>(k) / static_cast<double>(half);
      root_[k] = {math::cos(angle), -math::sin(angle)};
    }
  }

  void reverseBits() {
    for (std::size_t i = 1, j = 0; i < point_.size(); ++i) {
      std::size_t bit = point_.size() / 2;
      for (; (j & bit) != 0; bit /= 2) j ^= bit;
      j ^= bit;
      if (i < j) std::swap(point_[i], point_[j]);
    }
  }

  /// Transforms of `length` points from pairs of half that length.
  void combine(std::size_t length) {
    const std::size_t half = length / 2, step = stride_ * 2 * point_.size() / length;
    for (std::size_t first = 0; first < point_.size(); first += length)
      for (std::size_t k = 0; k < half; ++k) {
        const Complex even = point_[first + k], odd = product(root_[k * step], point_[first + half + k]);
        point_[first + k] = even + odd;
        point_[first + half + k] = even - odd;
      }
  }

  std::vector<Complex> root_;  ///< for the longest record so far
  std::vector<Complex> point_;
  std::size_t stride_ = 1;  ///< of root_, for the present record
};

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
