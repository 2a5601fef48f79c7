#pragma once

#include "vibe_core/common/arithmetic.hpp"

namespace vibe {

/// The versions of a kernel. The last three give the same bits; a kernel without one of its own for AVX-512 uses that
/// of AVX2 there.
enum class KernelPath { Plain, FusedSse2, Avx2, Avx512 };

/// The version for the arithmetic and the instruction set in use.
KernelPath kernelPath();

}  // namespace vibe
