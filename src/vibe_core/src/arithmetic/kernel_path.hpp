#pragma once

#include "vibe_core/arithmetic/machine.hpp"

/// In what vibe_kernels() compiles for an instruction set VIBE_KERNEL_SET is its name, Sse2, FusedSse2 or Avx2, and
/// VIBE_KERNEL(name) is nameSse2, nameFusedSse2 or nameAvx2: the function of a kernel for that set.
#define VIBE_KERNEL(name) VIBE_KERNEL_OF(name, VIBE_KERNEL_SET)
#define VIBE_KERNEL_OF(name, set) VIBE_KERNEL_JOINED(name, set)
#define VIBE_KERNEL_JOINED(name, set) name##set

namespace vibe {

/// The versions of a kernel. The last three give the same bits; a kernel without one of its own for AVX-512 uses that
/// of AVX2 there.
enum class KernelPath { Plain, FusedSse2, Avx2, Avx512 };

/// The version for the arithmetic and the instruction set in use.
KernelPath kernelPath();

}  // namespace vibe
