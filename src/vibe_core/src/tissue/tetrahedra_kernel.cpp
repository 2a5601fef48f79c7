#include "tissue/tetrahedra_kernel.hpp"

namespace vibe {

TetKernel chooseTetKernel() {
  const bool wide = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
  return wide ? tetKernelAvx2() : tetKernelSse2();
}

}  // namespace vibe
