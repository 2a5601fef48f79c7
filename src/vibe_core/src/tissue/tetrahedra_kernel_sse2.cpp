#include "tissue/tetrahedra_kernel_impl.hpp"

namespace vibe {

TetKernel tetKernelSse2() {
  return {"sse2", TetKernelOf<xsimd::sse2, 4>::sweep, TetKernelOf<xsimd::sse2, 10>::sweep};
}

}  // namespace vibe
