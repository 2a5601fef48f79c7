#include "tissue/shell_kernel_impl.hpp"

namespace vibe {

ShellKernel shellKernelAvx2() {
  using Kernel = ShellKernelOf<xsimd::fma3<xsimd::avx2>>;
  return {"avx2", sweepShell<Kernel>, Kernel::sweepFibres};
}

}  // namespace vibe
