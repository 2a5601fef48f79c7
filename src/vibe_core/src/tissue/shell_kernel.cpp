#include "tissue/shell_kernel.hpp"

namespace vibe {

ShellKernel shellKernel(KernelPath path) {
  switch (path) {
    case KernelPath::Avx512:
      return shellKernelAvx512();
    case KernelPath::Avx2:
      return shellKernelAvx2();
    case KernelPath::FusedSse2:
      return shellKernelFusedSse2();
    default:
      return shellKernelSse2();
  }
}

}  // namespace vibe
