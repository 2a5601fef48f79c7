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

}  // namespace vibe::vision
