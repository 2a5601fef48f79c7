#include "synthetic/random_field.hpp"

#include <algorithm>
#include <cstring>

namespace vibe::vision {

namespace {

/// Natural logarithm of a normal number in (0, 1), to 1e-6.
inline float logarithm(float x) {
  std::uint32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  const std::uint32_t shifted = bits - 0x3F3504F3U;  // mantissa in [sqrt(1/2), sqrt(2))
  const auto exponent = static_cast<std::int32_t>(shifted) >> 23;
  bits -= static_cast<std::uint32_t>(exponent) << 23;
  float mantissa;
  std::memcpy(&mantissa, &bits, sizeof mantissa);
  const float z = (mantissa - 1) / (mantissa + 1), zz = z * z;
  const float series = 2 * z * (1 + zz * (1.0F / 3 + zz * (0.2F + zz * (1.0F / 7 + zz * (1.0F / 9)))));
  return series + static_cast<float>(exponent) * 0.693147181F;
}

/// sin(2 pi t) for t in [-1/4, 1/4], to 1e-7.
inline float sineOfTurn(float t) {
  const float x = t * 6.28318531F, xx = x * x;
  return x * (1 + xx * (-1.0F / 6 + xx * (1.0F / 120 + xx * (-1.0F / 5040 + xx * (1.0F / 362880 - xx / 39916800)))));
}

/// Sine of a turn t in (0, 1) of the circle.
inline float sine(float t) {
  const float wrapped = t > 0.5F ? t - 1 : t;  // (-1/2, 1/2]
  const float folded = wrapped > 0.25F ? 0.5F - wrapped : (wrapped < -0.25F ? -0.5F - wrapped : wrapped);
  return sineOfTurn(folded);
}

/// Normal deviate (Box and Muller, 1958); its largest size is 5.8.
inline float normal(const RandomStream& random, std::uint32_t i) {
  const float radius = std::sqrt(-2 * logarithm(random.uniform(2 * i)));
  return radius * sine(random.uniform(2 * i + 1));
}

float smoothStep(float t) {
  return t * t * (3 - 2 * t);
}

}  // namespace

void addNoise(const RandomStream& random, std::uint32_t counter, const float* expected, int count, float gain,
              float variance, std::uint8_t* pixels) {
  for (int i = 0; i < count; ++i) {
    const float spread = gain * expected[i] + variance;
    const float deviation = std::sqrt(spread > 0 ? spread : 0.0F);
    const float value = expected[i] + deviation * normal(random, counter + static_cast<std::uint32_t>(i)) + 0.5F;
    const float clipped = value < 0 ? 0.0F : (value > 255 ? 255.0F : value);
    pixels[i] = static_cast<std::uint8_t>(static_cast<int>(clipped));
  }
}

Background::Background(int width, int height, double level, std::uint64_t seed)
    : width_(width),
      height_(height),
      stride_(static_cast<std::size_t>(width + 2 * kPadding)),
      values_(stride_ * static_cast<std::size_t>(height + 2 * kPadding), static_cast<float>(level)) {
  const auto relative = static_cast<float>(level / 90);
  addPatches(seed);
  addTexture(seed + 1, 61, 16 * relative);
  addTexture(seed + 2, 17, 12 * relative);
  addTexture(seed + 3, 5, 8 * relative);
  for (float& value : values_) value = std::clamp(value, 2.0F, 250.0F);
}

void Background::addTexture(std::uint64_t seed, int cell, float amplitude) {
  const RandomStream random(seed, 0xBAC6);
  const int height = height_ + 2 * kPadding, width = width_ + 2 * kPadding, columns = width / cell + 2;
  const auto knot = [&](int x, int y) { return 2 * random.uniform(static_cast<std::uint32_t>(y * columns + x)) - 1; };
  for (int y = 0; y < height; ++y) {
    const float v = smoothStep(static_cast<float>(y % cell) / static_cast<float>(cell));
    for (int x = 0; x < width; ++x) {
      const int i = x / cell, j = y / cell;
      const float u = smoothStep(static_cast<float>(x % cell) / static_cast<float>(cell));
      const float upper = knot(i, j) + u * (knot(i + 1, j) - knot(i, j));
      const float lower = knot(i, j + 1) + u * (knot(i + 1, j + 1) - knot(i, j + 1));
      values_[static_cast<std::size_t>(y) * stride_ + static_cast<std::size_t>(x)] +=
          amplitude * (upper + v * (lower - upper));
    }
  }
}

void Background::addPatches(std::uint64_t seed) {
  constexpr std::uint32_t kPatches = 14, kNumbers = 5;
  const RandomStream random(seed, 0x9A7C);
  for (std::uint32_t k = 0; k < kPatches; ++k) {
    const auto number = [&](std::uint32_t i, float low, float high) {
      return low + (high - low) * random.uniform(k * kNumbers + i);
    };
    const auto x0 = static_cast<int>(number(0, 0, static_cast<float>(width_)));
    const auto y0 = static_cast<int>(number(1, 0, static_cast<float>(height_)));
    const auto width = static_cast<int>(number(2, 10, 130)), height = static_cast<int>(number(3, 6, 60));
    const float change = number(4, -35, 45);
    for (int y = y0; y < std::min(y0 + height, height_ + kPadding); ++y)
      for (int x = x0; x < std::min(x0 + width, width_ + kPadding); ++x)
        values_[static_cast<std::size_t>(y + kPadding) * stride_ + static_cast<std::size_t>(x + kPadding)] += change;
  }
}

}  // namespace vibe::vision
