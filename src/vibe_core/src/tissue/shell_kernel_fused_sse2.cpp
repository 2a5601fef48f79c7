#include "tissue/shell_kernel_impl.hpp"

namespace vibe {

ShellKernel shellKernelFusedSse2() {
  using Kernel = ShellKernelOf<FusedSse2>;
  return {"sse2, fused", sweepShell<Kernel>, Kernel::sweepFibres};
}

}  // namespace vibe
