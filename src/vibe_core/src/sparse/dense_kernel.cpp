#include "sparse/dense_kernel.hpp"

namespace vibe {

DenseUpdate<float> floatUpdateSse2();
DenseUpdate<float> floatUpdateAvx2();
DenseUpdate<double> doubleUpdateSse2();
DenseUpdate<double> doubleUpdateAvx2();

template <>
DenseUpdate<float> denseUpdate(InstructionPath path) {
  return path == InstructionPath::Avx2 ? floatUpdateAvx2() : floatUpdateSse2();
}

template <>
DenseUpdate<double> denseUpdate(InstructionPath path) {
  return path == InstructionPath::Avx2 ? doubleUpdateAvx2() : doubleUpdateSse2();
}

}  // namespace vibe
