#pragma once
#include <cstdint>
#include <vector>

namespace vibe::vision {

/// What is behind the markers, in grey values at full light: cloth-like texture with straight-edged patches. It is
/// defined as the bilinear interpolation of values at the pixel centres, some pixels beyond the image too.
class Background {
 public:
  static constexpr int kPadding = 24;  ///< pixels around the image

  Background(int width, int height, double level, std::uint64_t seed);
  /// At pixel centres from (-kPadding, y). @param y  from -kPadding to height + kPadding - 1
  const float* row(int y) const { return values_.data() + static_cast<std::size_t>(y + kPadding) * stride_; }
  std::size_t stride() const { return stride_; }
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
