#pragma once
#include <cstdint>

namespace vibe {

/// SplitMix64 (Steele, Lea, Flood 2014): well mixed bits of a counter.
inline std::uint64_t mixed(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EB;
  return x ^ (x >> 31);
}

/// In [0, 1), a function of its arguments only.
inline double uniform(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) {
  return static_cast<double>(mixed(mixed(mixed(seed) ^ stream) ^ index) >> 11) * 0x1p-53;
}

}  // namespace vibe
