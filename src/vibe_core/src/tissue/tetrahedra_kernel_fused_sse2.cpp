#include "tissue/tetrahedra_kernel_impl.hpp"

namespace vibe {

TetKernel tetKernelFusedSse2() {
  return {"sse2, fused", TetKernelOf<FusedSse2, 4>::sweep, TetKernelOf<FusedSse2, 10>::sweep};
}

}  // namespace vibe
