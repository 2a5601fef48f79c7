#include "dataset/variation.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace vibe {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

/// Uniform numbers, the same with every standard library.
class Draw {
 public:
  explicit Draw(std::uint32_t seed) : random_(seed) {}
  double between(double min, double max) { return min + (max - min) * static_cast<double>(random_()) / 4294967295.0; }
  double factor(double min, double max) { return std::exp(between(std::log(min), std::log(max))); }

 private:
  std::mt19937 random_;
};

}  // namespace

CameraVariation variationOf(std::uint32_t seed, double field_of_view) {
  Draw draw(seed);
  CameraVariation result;
  result.field_of_view = std::clamp(field_of_view + draw.between(-5, 5) * kDegree, kMinFieldOfView, kMaxFieldOfView);
  result.roll = draw.between(-5, 5) * kDegree;
  result.pitch = draw.between(-2, 2) * kDegree, result.yaw = draw.between(-2, 2) * kDegree;
  SensorStyle& sensor = result.sensor;
  sensor.exposure = draw.factor(0.7, 1.4);
  sensor.red_gain = draw.between(0.9, 1.1), sensor.blue_gain = draw.between(0.9, 1.1);
  sensor.vignetting = draw.between(0.05, 0.4);
  sensor.blur = draw.between(0.3, 0.9);
  sensor.distortion = draw.between(-0.03, 0.03);
  sensor.full_well = draw.factor(2000, 12000);
  sensor.read_noise = draw.between(0.001, 0.006);
  sensor.seed = seed;
  return result;
}

}  // namespace vibe
