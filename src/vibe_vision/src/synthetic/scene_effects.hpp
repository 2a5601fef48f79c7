#pragma once
#include <vector>

#include "synthetic/marker_frame.hpp"

namespace vibe::vision {

/// Mean light from `begin` to `end` [s], relative to full light.
double meanLight(const Degradation& degradation, double begin, double end);

/// Share of the light that the lens lets through to a pixel.
double vignetteAt(const SyntheticScene& scene, double x, double y);

/// A bar that sweeps to and fro across the image, in front of everything.
class Occluder {
 public:
  Occluder(const SyntheticScene& scene);
  bool present() const { return present_; }
  /// Its middle in row y, at a time [s]. [px]
  double middle(double time, double y) const;
  double halfWidth() const { return half_width_; }  ///< [px]
  double speed() const { return speed_; }           ///< [px/s]
  double slope() const { return slope_; }           ///< columns per row
  float value() const { return value_; }            ///< [DN] at full light

 private:
  bool present_;
  double width_, height_, half_width_, speed_, slope_;
  float value_;
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
