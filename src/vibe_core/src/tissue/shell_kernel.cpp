#include "tissue/shell_kernel.hpp"

namespace vibe {

bool haveAvx512() {
  return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0 &&
         __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512vl") != 0 &&
         __builtin_cpu_supports("avx512bw") != 0 && __builtin_cpu_supports("avx512dq") != 0;
}

ShellKernel chooseShellKernel() {
  if (haveAvx512()) return shellKernelAvx512();
  const bool wide = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
  return wide ? shellKernelAvx2() : shellKernelSse2();
}

}  // namespace vibe
