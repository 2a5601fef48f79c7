#include "synthetic/degradation.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "synthetic/random_field.hpp"

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

namespace {

constexpr double kFlicker = 100;       // of lamps on 50 Hz mains [Hz]
constexpr double kDriftTime = 1;       // in which the light falls, and as long to rise again [s]
constexpr double kBarWidth = 6e-3;     // [m]
constexpr double kBarSpeed = 0.1;      // [m/s]
constexpr float kSpotPeak = 600;       // [DN]: saturated within about 4 px
constexpr float kSpotDeviation = 2;    // [px]
constexpr double kLookAlike = 0.75;    // of the marker's size
constexpr double kLookAlikeClear = 4;  // between it and the marker [px]

/// From 0 to 1 and back, with slope +-1 / half.
double triangle(double time, double half) {
  const double phase = time / (2 * half) - std::floor(time / (2 * half));
  return phase < 0.5 ? 2 * phase : 2 - 2 * phase;
}

double meanScale(const SyntheticScene& scene) {
  double sum = 0;
  for (const SyntheticInstrument& i : scene.instruments) sum += i.nominal.axis.pixels_per_metre;
  return scene.instruments.empty() ? 0 : sum / static_cast<double>(scene.instruments.size());
}

/// Half extents of what is printed on a marker, without the white around it [m].
Eigen::Vector2d patternExtents(const SyntheticInstrument& instrument) {
  if (instrument.tag.cells > 0) return Eigen::Vector2d::Constant(instrument.tag.side / 2 * instrument.scale);
  if (const auto* ring = std::get_if<RingDesign>(&instrument.nominal.marker))
    return Eigen::Vector2d::Constant(ring->outer_diameter / 2 * instrument.scale);
  return halfExtents(instrument);
}

/// Passes beside the instrument on a parallel line, against its direction of motion.
SyntheticInstrument lookAlike(const SyntheticInstrument& instrument) {
  SyntheticInstrument other = instrument;
  const double half = halfExtents(instrument).y();
  other.scale = kLookAlike * instrument.scale;
  other.lateral =
      instrument.lateral - (1 + kLookAlike) * half - kLookAlikeClear / instrument.nominal.axis.pixels_per_metre;
  const double middle = (instrument.nominal.lower + instrument.nominal.upper) / 2;
  const auto slide = instrument.motion.slide;
  other.motion.slide = [slide, middle](double time) { return 2 * middle - 0.8 * slide(0.7 * time + 0.13); };
  return other;
}

}  // namespace

double meanLight(const Degradation& degradation, double begin, double end) {
  const double turn = 2 * M_PI * kFlicker, middle = (begin + end) / 2, half = turn * (end - begin) / 2;
  const double attenuation = half > 1e-9 ? std::sin(half) / half : 1;
  const double flicker = degradation.flicker * std::sin(turn * middle) * attenuation;
  return (1 + flicker) * (1 - degradation.drift * kDriftTime * triangle(middle, kDriftTime));
}

double vignetteAt(const SyntheticScene& scene, double x, double y) {
  const double x0 = (scene.camera.width - 1) / 2.0, y0 = (scene.camera.height - 1) / 2.0;
  const double dx = x - x0, dy = y - y0;
  return 1 - scene.degradation.vignetting * (dx * dx + dy * dy) / (x0 * x0 + y0 * y0);
}

Occluder::Occluder(const SyntheticScene& scene)
    : present(scene.degradation.occluder),
      width(scene.camera.width),
      height(scene.camera.height),
      half_width(kBarWidth * meanScale(scene) / 2),
      speed(kBarSpeed * meanScale(scene)),
      value(static_cast<float>(0.55 * scene.background)) {}

double Occluder::middle(double time, double y) const {
  const double reach = width + 2 * half_width;
  return reach * triangle(time, reach / std::max(speed, 1.0)) - half_width + slope * (y - height / 2);
}

Highlights::Highlights(const SyntheticScene& scene, std::size_t instrument) {
  const int wanted = scene.degradation.highlights;
  if (wanted <= 0) return;
  const SyntheticInstrument& object = scene.instruments[instrument];
  const InstrumentConfig& nominal = object.nominal;
  const AxisLine line = axisLine(scene.camera, nominal.axis);
  const Eigen::Vector3d across = Eigen::Vector3d::UnitZ().cross(line.direction).normalized();
  const Eigen::Vector2d half = patternExtents(object);
  const double spacing = 2 * half.x() / wanted;
  const RandomStream random(scene.seed, 0x5907 + instrument);
  std::uint32_t k = 0;
  for (double s = nominal.lower - half.x(); s < nominal.upper + half.x(); s += spacing, ++k) {
    const double along = s + spacing * (random.uniform(2 * k) - 0.5) * 0.6;
    const double lateral = object.lateral + half.y() * (2 * random.uniform(2 * k + 1) - 1) * 0.75;
    places_.push_back(project(scene.camera, line.origin + along * line.direction + lateral * across).cast<float>());
  }
}

void Highlights::addTo(float* values, const float* coverage, int count, float x, float step, float y) const {
  const float reach = 6 * kSpotDeviation, fall = 0.5F / (kSpotDeviation * kSpotDeviation);
  for (const Eigen::Vector2f& place : places_) {
    const float dy = y - place.y();
    if (std::abs(dy) > reach) continue;
    const int first = std::max(0, static_cast<int>((place.x() - reach - x) / step));
    const int last = std::min(count, static_cast<int>((place.x() + reach - x) / step) + 1);
    for (int i = first; i < last; ++i) {
      const float dx = x + static_cast<float>(i) * step - place.x();
      values[i] += coverage[i] * kSpotPeak * std::exp(-fall * (dx * dx + dy * dy));
    }
  }
}

std::vector<SyntheticInstrument> objectsOf(const SyntheticScene& scene) {
  std::vector<SyntheticInstrument> objects = scene.instruments;
  if (scene.degradation.look_alike)
    for (const SyntheticInstrument& instrument : scene.instruments) objects.push_back(lookAlike(instrument));
  return objects;
}

}  // namespace vibe::vision
