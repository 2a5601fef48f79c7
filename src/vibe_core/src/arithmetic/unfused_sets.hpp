#pragma once

#include <xsimd/xsimd.hpp>

namespace vibe {

/// What UnfusedSets::VIBE_KERNEL_SET compiles for, in kernels in which no operation is fused; see KernelSets for
/// others.
struct UnfusedSets {
  using Sse2 = xsimd::sse2;
  using Avx2 = xsimd::avx2;
};

}  // namespace vibe
