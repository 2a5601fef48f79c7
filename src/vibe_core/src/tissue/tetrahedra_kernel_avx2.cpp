#include "tissue/tetrahedra_kernel_impl.hpp"

namespace vibe {

TetKernel tetKernelAvx2() {
  return {"avx2", TetKernelOf<xsimd::fma3<xsimd::avx2>, 4>::sweep, TetKernelOf<xsimd::fma3<xsimd::avx2>, 10>::sweep};
}

}  // namespace vibe
