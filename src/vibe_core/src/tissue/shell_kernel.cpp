#include "tissue/shell_kernel.hpp"

namespace vibe {

ShellKernel chooseShellKernel() {
  const bool wide = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
  return wide ? shellKernelAvx2() : shellKernelSse2();
}

}  // namespace vibe
