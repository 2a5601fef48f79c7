#include "tissue/tetrahedra_kernel.hpp"

namespace vibe {

TetKernel tetKernel(KernelPath path) {
  if (path == KernelPath::Plain) return tetKernelSse2();
  return path == KernelPath::FusedSse2 ? tetKernelFusedSse2() : tetKernelAvx2();
}

}  // namespace vibe
