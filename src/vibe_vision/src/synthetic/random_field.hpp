#pragma once

#include <cstdint>
#include <vector>

#include "vibe_core/arithmetic/random.hpp"

namespace vibe::vision {

/// Random numbers by counter: number i of a stream is a function of its seed and i alone, with integer arithmetic and
/// single-precision operations that IEEE 754 rounds exactly. The same on every machine, in any order.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::uint64_t stream) {
    const std::uint64_t key = mixed(mixed(seed) ^ (stream * 0x9E3779B97F4A7C15ULL));
    first_ = static_cast<std::uint32_t>(key);
    second_ = static_cast<std::uint32_t>(key >> 32);
  }

  std::uint32_t bits(std::uint32_t i) const { return mix32(mix32(i + first_) ^ second_); }
  /// In (0, 1).
  float uniform(std::uint32_t i) const { return (static_cast<float>(bits(i) >> 9) + 0.5F) * (1.0F / 8388608.0F); }

 private:
  static std::uint32_t mix32(std::uint32_t x) {  // two multiplications, full avalanche
    x = (x ^ (x >> 16)) * 0x7FEB352DU;
    x = (x ^ (x >> 15)) * 0x846CA68BU;
    return x ^ (x >> 16);
  }

  std::uint32_t first_ = 0, second_ = 0;
};

/// Adds photon and read noise, rounds and clips. @param counter  of the first pixel
/// @param expected  grey values without noise; @param gain, variance  of the noise: gain * value + variance [DN, DN^2]
void addNoise(const RandomStream& random, std::uint32_t counter, const float* expected, int count, float gain,
              float variance, std::uint8_t* pixels);

/// What is behind the markers, in grey values at full light: cloth-like texture with straight-edged patches. It is
/// defined as the bilinear interpolation of values at the pixel centres, some pixels beyond the image too.
class Background {
 public:
  static constexpr int kPadding = 24;  ///< pixels around the image

  Background(int width, int height, double level, std::uint64_t seed);
  /// At pixel centres from (-kPadding, y). @param y  from -kPadding to height + kPadding - 1
  const float* row(int y) const { return values_.data() + static_cast<std::size_t>(y + kPadding) * stride_; }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  void addTexture(std::uint64_t seed, int cell, float amplitude);
  void addPatches(std::uint64_t seed);

  int width_, height_;
  std::size_t stride_;
  std::vector<float> values_;
};

}  // namespace vibe::vision
