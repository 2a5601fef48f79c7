#include "sparse/dense_kernel_impl.hpp"

namespace vibe {

DenseUpdate<float> floatUpdateSse2() {
  return DenseKernel<float, xsimd::sse2>::update;
}

DenseUpdate<double> doubleUpdateSse2() {
  return DenseKernel<double, xsimd::sse2>::update;
}

}  // namespace vibe
