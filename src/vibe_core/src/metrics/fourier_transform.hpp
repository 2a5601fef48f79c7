#pragma once

#include <cmath>
#include <complex>
#include <utility>
#include <vector>

#include "common/elementary.hpp"

namespace vibe {

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

}  // namespace vibe
