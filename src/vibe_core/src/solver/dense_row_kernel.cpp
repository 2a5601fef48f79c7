#include "solver/dense_row_kernel.hpp"

#include "arithmetic/kernel_path.hpp"

namespace vibe {

DenseRowKernels denseRowKernelsSse2();
DenseRowKernels denseRowKernelsAvx2();

DenseRowKernels denseRowKernels() {
  const KernelPath path = kernelPath();
  return path == KernelPath::Avx2 || path == KernelPath::Avx512 ? denseRowKernelsAvx2() : denseRowKernelsSse2();
}

}  // namespace vibe
