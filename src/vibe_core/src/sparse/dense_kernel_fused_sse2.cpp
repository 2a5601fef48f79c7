#include "sparse/dense_kernel_impl.hpp"

namespace vibe {

DenseUpdate<float> floatUpdateFusedSse2() {
  return DenseKernel<float, FusedSse2>::update;
}

DenseUpdate<double> doubleUpdateFusedSse2() {
  return DenseKernel<double, FusedSse2>::update;
}

}  // namespace vibe
