#include "tissue/shell_kernel_impl.hpp"

namespace vibe {

ShellKernel shellKernelAvx2() {
  return {"avx2", ShellKernelOf<xsimd::fma3<xsimd::avx2>>::sweep, ShellKernelOf<xsimd::fma3<xsimd::avx2>>::sweepFibres};
}

}  // namespace vibe
