#pragma once

#include <cstddef>

#include "vibe_vision/track/marker_pattern.hpp"

namespace vibe::vision {

/// Four floats of a vector register; compilers without the instructions take several. Sums below are always taken in
/// the same order, and nothing is fused: the same bits on every machine.
using Four [[gnu::vector_size(16)]] = float;
constexpr std::size_t kFourSize = 4;

/// Two of them, anywhere in an array of floats; one register in a function with VIBE_LANES.
using Eight [[gnu::vector_size(32), gnu::aligned(4), gnu::may_alias]] = float;

inline Four loadFour(const float* p) {
  Four v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}

inline void store(float* p, Four v) {
  __builtin_memcpy(p, &v, sizeof v);
}

inline double total(Four s) {
  return (static_cast<double>(s[0]) + s[1]) + (static_cast<double>(s[2]) + s[3]);
}

/// @param count  a multiple of kLanes
inline double total(const float* p, std::size_t count) {
  Four a{}, b{};
  for (std::size_t i = 0; i < count; i += kLanes) a += loadFour(p + i), b += loadFour(p + i + 4);
  return total(a + b);
}

inline double dot(const float* p, const float* q, std::size_t count) {
  Four a{}, b{};
  for (std::size_t i = 0; i < count; i += kLanes) {
    a += loadFour(p + i) * loadFour(q + i);
    b += loadFour(p + i + 4) * loadFour(q + i + 4);
  }
  return total(a + b);
}

}  // namespace vibe::vision

/// Before a function whose loops the compiler turns into vector instructions: made a second time for processors with
/// AVX2, chosen when the program starts. The results are the same bits.
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__)
#define VIBE_LANES [[gnu::target_clones("avx2", "default")]]
#else
#define VIBE_LANES
#endif

namespace vibe::vision {

inline double square(double x) {
  return x * x;
}

/// Of the area of a pixel [px^2].
constexpr double kPixelVariance = 1.0 / 12;

}  // namespace vibe::vision
