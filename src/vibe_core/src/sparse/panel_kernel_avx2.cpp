#include "sparse/panel_kernel_impl.hpp"

namespace vibe {

PanelKernels halfKernelsAvx2() {
  return PanelKernel<xsimd::fma3<xsimd::avx2>, std::uint16_t>::functions();
}

PanelKernels floatKernelsAvx2() {
  return PanelKernel<xsimd::fma3<xsimd::avx2>, float>::functions();
}

}  // namespace vibe
