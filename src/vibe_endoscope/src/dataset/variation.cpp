#include "dataset/variation.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace vibe::endoscope {
namespace {

/// Uniform numbers, the same with every standard library.
class Draw {
 public:
  explicit Draw(std::uint32_t seed) : random_(seed) {}
  double between(double min, double max) { return min + (max - min) * static_cast<double>(random_()) / 4294967295.0; }
  double factor(double min, double max) { return std::exp(between(std::log(min), std::log(max))); }

 private:
  std::mt19937 random_;
};

graphics::MucosaLook drawMucosa(Draw& draw) {
  graphics::MucosaLook mucosa;
  for (int axis = 0; axis < 3; ++axis) mucosa.shift[axis] = static_cast<float>(draw.between(0, 0.5));
  mucosa.areae_size = draw.between(2e-3, 5e-3);
  mucosa.paleness = draw.factor(0.8, 1.25);
  mucosa.yellowness = draw.factor(0.92, 1.09);
  mucosa.vessels = draw.factor(0.3, 2);
  mucosa.wetness = draw.factor(0.6, 1.6);
  mucosa.mucus = draw.between(-0.06, 0.08);
  return mucosa;
}

graphics::EndoscopeLight drawLight(Draw& draw) {
  graphics::EndoscopeLight light;
  for (graphics::LightGuide& guide : light.guides) {
    guide.right = std::copysign(draw.between(2.8e-3, 3.8e-3), guide.right);
    guide.up = draw.between(0, 1.25e-3);
  }
  const double ratio = draw.factor(0.6, 1.67);
  light.guides[0].strength = 2 * ratio / (1 + ratio), light.guides[1].strength = 2 / (1 + ratio);
  light.sideward = draw.between(0.15, 0.45);
  light.temperature = draw.between(4800, 7000);
  return light;
}

}  // namespace

Variation variationOf(std::uint32_t seed, double field_of_view) {
  Draw draw(seed);
  Variation result;
  result.field_of_view = std::clamp(field_of_view + draw.between(-5, 5) * graphics::kDegree, graphics::kMinFieldOfView,
                                    graphics::kMaxFieldOfView);
  result.roll = draw.between(-5, 5) * graphics::kDegree;
  result.pitch = draw.between(-2, 2) * graphics::kDegree, result.yaw = draw.between(-2, 2) * graphics::kDegree;
  SensorStyle& sensor = result.sensor;
  sensor.exposure = draw.factor(0.7, 1.4);
  sensor.red_gain = draw.between(0.9, 1.1), sensor.blue_gain = draw.between(0.9, 1.1);
  sensor.vignetting = draw.between(0.05, 0.4);
  sensor.blur = draw.between(0.3, 0.9);
  sensor.distortion = draw.between(-0.03, 0.03);
  sensor.full_well = draw.factor(2000, 12000);
  sensor.read_noise = draw.between(0.001, 0.006);
  sensor.seed = seed;
  // last, so that what came before is as in data sets of earlier versions
  result.mucosa = drawMucosa(draw);
  result.light = drawLight(draw);
  return result;
}

}  // namespace vibe::endoscope
