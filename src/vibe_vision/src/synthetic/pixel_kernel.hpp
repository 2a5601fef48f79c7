#pragma once
#include <vector>

namespace vibe::vision {

/// Optics and pixel aperture in one dimension: Gaussian point spread function, integrated over the pixel's width. Works
/// on samples that are means over 1 / samples of a pixel each.
class PixelKernel {
 public:
  /// @param sigma    of the point spread function [px]
  /// @param samples  per pixel and direction: 2 or 4
  PixelKernel(double sigma, int samples);
  int samples() const { return samples_; }
  int margin() const { return margin_; }  ///< pixels needed on both sides of the first and last one

  /// Weights of the samples from the first of pixel -margin to the last of pixel +margin; they add up to 1.
  const std::vector<float>& weights() const { return weights_; }
  /// Weights on values at pixel centres with bilinear interpolation in between, from -margin - 1 to margin + 1.
  const std::vector<float>& latticeWeights() const { return lattice_; }

  /// Pixels from samples in a row. @param samples  (count + 2 margin) samples of them
  void alongRow(const float* samples, int count, float* pixels) const;

 private:
  template <int kSamples>
  void sumAlongRow(const float* samples, int count, float* pixels) const;

  int samples_, margin_;
  std::vector<float> weights_, lattice_;
};

}  // namespace vibe::vision
