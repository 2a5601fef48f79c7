#include "sparse/dense_kernel_impl.hpp"

namespace vibe {

DenseUpdate denseUpdateAvx2() {
  return DenseKernel<xsimd::fma3<xsimd::avx2>>::update;
}

}  // namespace vibe
