#include "tissue/shell_kernel_impl.hpp"

namespace vibe {

ShellKernel shellKernelSse2() {
  using Kernel = ShellKernelOf<xsimd::sse2>;
  return {"sse2", sweepShell<Kernel>, Kernel::sweepFibres};
}

}  // namespace vibe
