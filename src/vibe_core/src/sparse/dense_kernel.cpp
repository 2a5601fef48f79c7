#include "sparse/dense_kernel.hpp"

namespace vibe {

DenseUpdate denseUpdateSse2();
DenseUpdate denseUpdateAvx2();

DenseUpdate denseUpdate(InstructionPath path) {
  return path == InstructionPath::Avx2 ? denseUpdateAvx2() : denseUpdateSse2();
}

}  // namespace vibe
