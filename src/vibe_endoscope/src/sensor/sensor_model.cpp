#include "sensor/sensor_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace vibe::endoscope {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kKernelReach = 3;  // standard deviations that the blur covers
constexpr int kNewtonSteps = 12;    // enough for double precision where the distortion is monotonic
constexpr int kLevels = 4096;       // of the table from light to sRGB; finer than the 8 bits of the result

double decoded(double value) {
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

double encoded(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

const std::array<float, 256>& decodingTable() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> values{};
    for (std::size_t k = 0; k < values.size(); ++k)
      values[k] = static_cast<float>(decoded(static_cast<double>(k) / 255));
    return values;
  }();
  return table;
}

/// Level of light where the rounded 8-bit value changes from k to k + 1.
const std::array<float, 255>& encodingSteps() {
  static const std::array<float, 255> steps = [] {
    std::array<float, 255> values{};
    for (std::size_t k = 0; k < values.size(); ++k)
      values[k] = static_cast<float>(decoded((static_cast<double>(k) + 0.5) / 255));
    return values;
  }();
  return steps;
}

std::uint8_t level(float light) {
  // a start from a table, then the exact step: rounding is that of the definition
  static const std::array<std::uint8_t, kLevels + 1> start = [] {
    std::array<std::uint8_t, kLevels + 1> values{};
    for (std::size_t k = 0; k < values.size(); ++k)
      values[k] = static_cast<std::uint8_t>(std::lround(255 * encoded(static_cast<double>(k) / kLevels)));
    return values;
  }();
  const auto& steps = encodingSteps();
  const float clamped = std::clamp(light, 0.0F, 1.0F);
  int value = start[static_cast<std::size_t>(clamped * kLevels)];
  while (value < 255 && clamped >= steps[static_cast<std::size_t>(value)]) ++value;
  while (value > 0 && clamped < steps[static_cast<std::size_t>(value - 1)]) --value;
  return static_cast<std::uint8_t>(value);
}

/// SplitMix64 (Steele, Lea and Flood 2014): a hash that passes statistical tests, so that noise needs no order.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}

/// Two independent values of the standard normal distribution (Box and Muller 1958).
std::array<float, 2> normals(std::uint64_t key) {
  const std::uint64_t bits = mixed(key);
  const double a = (static_cast<double>(bits >> 32) + 0.5) / 4294967296.0;
  const double b = (static_cast<double>(bits & 0xffffffffU) + 0.5) / 4294967296.0;
  const double radius = std::sqrt(-2 * std::log(a));
  return {static_cast<float>(radius * std::cos(2 * kPi * b)), static_cast<float>(radius * std::sin(2 * kPi * b))};
}

/// What the model of the lens distorts: the angle or its tangent. `slope` is r / f.
double bent(double slope, double k1) {
  return slope * (1 + k1 * slope * slope);
}

/// r / f at the rim of the circle, without distortion.
double rimOf(const graphics::RoundCamera& camera) {
  return camera.radius() / graphics::focalLength(camera);
}

}  // namespace

bool SensorStyle::isPlain() const {
  return exposure == 1 && red_gain == 1 && blue_gain == 1 && vignetting == 0 && blur == 0 && distortion == 0 &&
         full_well == 0 && read_noise == 0;
}

std::string problemOf(const SensorStyle& style, const graphics::RoundCamera& camera) {
  const double rim = rimOf(camera);
  if (!(1 + 3 * style.distortion * rim * rim > 0.05))
    return "the distortion folds the image over; make it weaker or the field of view smaller";
  return "";
}

Eigen::Vector2d distorted(const SensorStyle& style, const graphics::RoundCamera& camera, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d aside = pixel - camera.middle();
  const double slope = aside.norm() / graphics::focalLength(camera);
  return camera.middle() + (1 + style.distortion * slope * slope) * aside;
}

Eigen::Vector2d undistorted(const SensorStyle& style, const graphics::RoundCamera& camera,
                            const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d aside = pixel - camera.middle();
  const double wanted = aside.norm() / graphics::focalLength(camera);
  if (wanted == 0) return pixel;
  double slope = std::min(wanted, rimOf(camera));
  for (int k = 0; k < kNewtonSteps; ++k)
    slope -= (bent(slope, style.distortion) - wanted) / (1 + 3 * style.distortion * slope * slope);
  return camera.middle() + slope / wanted * aside;
}

SensorModel::SensorModel(const SensorStyle& style, const graphics::RoundCamera& camera)
    : style_(style), camera_(camera) {
  const int reach = style.blur > 0 ? static_cast<int>(std::ceil(kKernelReach * style.blur)) : 0;
  for (int k = 0; k <= reach && reach > 0; ++k)
    kernel_.push_back(static_cast<float>(std::exp(-0.5 * k * k / (style.blur * style.blur))));
  float sum = 0;
  for (std::size_t k = 0; k < kernel_.size(); ++k) sum += (k == 0 ? 1 : 2) * kernel_[k];
  for (float& weight : kernel_) weight /= sum;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const double aside = (Eigen::Vector2d(x, y) - camera.middle()).norm() / camera.radius();
      const bool inside = aside <= 1 + 0.5 / camera.radius();  // with the soft rim of the drawn circle
      share_.push_back(
          inside ? static_cast<float>(style.exposure * (1 - style.vignetting * std::min(1.0, aside * aside))) : 0.0F);
      if (style.distortion == 0) continue;
      const Eigen::Vector2d source = undistorted(style, camera, Eigen::Vector2d(x, y));
      source_.push_back(static_cast<float>(source.x())), source_.push_back(static_cast<float>(source.y()));
    }
}

void SensorModel::expose(std::vector<std::uint8_t>& pixels, std::uint64_t number) {
  if (style_.isPlain()) return;
  linearise(pixels);
  if (!source_.empty()) distort();
  if (!kernel_.empty()) blur();
  develop(pixels, number);
}

void SensorModel::linearise(const std::vector<std::uint8_t>& pixels) {
  light_.resize(pixels.size());
  for (std::size_t k = 0; k < pixels.size(); ++k) light_[k] = decodingTable()[pixels[k]];
}

// Bilinear; black beyond the edges.
void SensorModel::distort() {
  scratch_.assign(light_.size(), 0.0F);
  for (std::size_t k = 0; 2 * k < source_.size(); ++k) {
    const float x = source_[2 * k], y = source_[2 * k + 1];
    const auto left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
    for (int corner = 0; corner < 4; ++corner) {
      const int column = left + (corner & 1), row = top + (corner >> 1);
      if (column < 0 || row < 0 || column >= camera_.width || row >= camera_.height) continue;
      const float weight = (1 - std::abs(x - static_cast<float>(column))) * (1 - std::abs(y - static_cast<float>(row)));
      const std::size_t from = 3 * (static_cast<std::size_t>(row) * camera_.width + column);
      for (std::size_t c = 0; c < 3; ++c) scratch_[3 * k + c] += weight * light_[from + c];
    }
  }
  light_.swap(scratch_);
}

void SensorModel::blur() {
  const auto width = static_cast<std::size_t>(camera_.width);
  scratch_.resize(light_.size());
  for (int y = 0; y < camera_.height; ++y) blurLine(3 * width * y, 3, camera_.width);
  light_.swap(scratch_);
  for (int x = 0; x < camera_.width; ++x) blurLine(3 * static_cast<std::size_t>(x), 3 * width, camera_.height);
  light_.swap(scratch_);
}

/// A row or a column of light_ into scratch_; the last pixels go on beyond the edges.
void SensorModel::blurLine(std::size_t first, std::size_t step, int count) {
  for (int k = 0; k < count; ++k)
    for (std::size_t c = 0; c < 3; ++c) {
      float sum = kernel_[0] * light_[first + step * k + c];
      for (int j = 1; j < static_cast<int>(kernel_.size()); ++j)
        sum += kernel_[j] *
               (light_[first + step * std::max(0, k - j) + c] + light_[first + step * std::min(count - 1, k + j) + c]);
      scratch_[first + step * k + c] = sum;
    }
}

void SensorModel::develop(std::vector<std::uint8_t>& pixels, std::uint64_t number) const {
  const auto shot = static_cast<float>(style_.full_well > 0 ? 1 / style_.full_well : 0);
  const auto read = static_cast<float>(style_.read_noise * style_.read_noise);
  const bool noisy = shot > 0 || read > 0;
  const std::array<float, 3> gain{static_cast<float>(style_.red_gain), 1, static_cast<float>(style_.blue_gain)};
  const std::uint64_t base = mixed(mixed(style_.seed) ^ number);
  for (std::size_t k = 0; k < share_.size(); ++k) {
    if (share_[k] == 0) {  // processors mask what is outside of the circle
      std::fill_n(&pixels[3 * k], 3, std::uint8_t{0});
      continue;
    }
    std::array<float, 4> noise{};
    for (std::size_t c = 0; noisy && c < 4; c += 2) {
      const std::array<float, 2> pair = normals(base + 2 * k + c / 2);
      noise[c] = pair[0], noise[c + 1] = pair[1];
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const float light = gain[c] * share_[k] * light_[3 * k + c];
      pixels[3 * k + c] = level(noisy ? light + noise[c] * std::sqrt(shot * light + read) : light);
    }
  }
}

}  // namespace vibe::endoscope
