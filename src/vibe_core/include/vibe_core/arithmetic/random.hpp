#pragma once
#include <cstdint>

namespace vibe {

/// SplitMix64 (Steele, Lea, Flood 2014, "Fast splittable pseudorandom number generators", figure 16). Gives the same
/// numbers on every machine, unlike the distributions of the standard library.
/// @param state  any number as seed; each call advances it
inline std::uint64_t nextInteger(std::uint64_t& state) {
  std::uint64_t z = state += 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/// The first number of the seed `x`: well mixed bits, as of a counter.
inline std::uint64_t mixed(std::uint64_t x) {
  return nextInteger(x);
}

/// Uniform in [0, 1), a multiple of 2^-53.
inline double nextUniform(std::uint64_t& state) {
  return static_cast<double>(nextInteger(state) >> 11) * 0x1.0p-53;
}

}  // namespace vibe
