#include "sparse/dense_kernel.hpp"

namespace vibe {

DenseUpdate<float> floatUpdateSse2();
DenseUpdate<float> floatUpdateFusedSse2();
DenseUpdate<float> floatUpdateAvx2();
DenseUpdate<double> doubleUpdateSse2();
DenseUpdate<double> doubleUpdateFusedSse2();
DenseUpdate<double> doubleUpdateAvx2();

template <>
DenseUpdate<float> denseUpdate(KernelPath path) {
  if (path == KernelPath::Plain) return floatUpdateSse2();
  return path == KernelPath::FusedSse2 ? floatUpdateFusedSse2() : floatUpdateAvx2();
}

template <>
DenseUpdate<double> denseUpdate(KernelPath path) {
  if (path == KernelPath::Plain) return doubleUpdateSse2();
  return path == KernelPath::FusedSse2 ? doubleUpdateFusedSse2() : doubleUpdateAvx2();
}

}  // namespace vibe
