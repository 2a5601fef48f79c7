#pragma once

#include <vector>

#include "synthetic/scene_geometry.hpp"

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

/// Mean light from `begin` to `end` [s], relative to full light.
double meanLight(const Degradation& degradation, double begin, double end);

/// Share of the light that the lens lets through to a pixel.
double vignetteAt(const SyntheticScene& scene, double x, double y);

/// A bar that sweeps to and fro across the image, in front of everything.
struct Occluder {
  explicit Occluder(const SyntheticScene& scene);
  /// Its middle in row y, at a time [s]. [px]
  double middle(double time, double y) const;

  bool present;
  double width, height;      ///< of the image [px]
  double half_width, speed;  ///< [px], [px/s]
  double slope = 0.08;       ///< columns per row
  float value;               ///< [DN] at full light
};

/// Reflections of lamps on glossy markers. They keep their place in the image: a row of them lies along the path of
/// each instrument, so dense that there are always `highlights` on the marker; the matt background shows none.
class Highlights {
 public:
  Highlights(const SyntheticScene& scene, std::size_t instrument);
  /// Adds the grey values at full light. @param x, y  distorted [px]
  void addTo(float* values, const float* coverage, int count, float x, float step, float y) const;

 private:
  std::vector<Eigen::Vector2f> places_;
};

/// The instruments of a scene and behind them their look-alikes.
std::vector<SyntheticInstrument> objectsOf(const SyntheticScene& scene);

}  // namespace vibe::vision
