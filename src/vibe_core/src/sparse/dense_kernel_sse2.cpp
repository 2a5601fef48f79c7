#include "sparse/dense_kernel_impl.hpp"

namespace vibe {

DenseUpdate denseUpdateSse2() {
  return DenseKernel<xsimd::sse2>::update;
}

}  // namespace vibe
