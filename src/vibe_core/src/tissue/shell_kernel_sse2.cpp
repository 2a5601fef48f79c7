#include "tissue/shell_kernel_impl.hpp"

namespace vibe {

ShellKernel shellKernelSse2() {
  return {"sse2", ShellKernelOf<xsimd::sse2>::sweep, ShellKernelOf<xsimd::sse2>::sweepFibres};
}

}  // namespace vibe
