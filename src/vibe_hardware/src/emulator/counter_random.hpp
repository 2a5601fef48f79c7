#pragma once
#include <cstdint>

#include "vibe_core/common/random.hpp"

namespace vibe::hardware {

/// In [0, 1), a function of its arguments only.
inline double uniform(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) {
  return static_cast<double>(mixed(mixed(mixed(seed) ^ stream) ^ index) >> 11) * 0x1p-53;
}

}  // namespace vibe::hardware
