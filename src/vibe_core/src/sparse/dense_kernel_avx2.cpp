#include "sparse/dense_kernel_impl.hpp"

namespace vibe {

DenseUpdate<float> floatUpdateAvx2() {
  return DenseKernel<float, xsimd::fma3<xsimd::avx2>>::update;
}

DenseUpdate<double> doubleUpdateAvx2() {
  return DenseKernel<double, xsimd::fma3<xsimd::avx2>>::update;
}

}  // namespace vibe
