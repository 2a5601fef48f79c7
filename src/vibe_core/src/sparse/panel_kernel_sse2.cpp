#include "sparse/panel_kernel_impl.hpp"

namespace vibe {

PanelKernels halfKernelsSse2() {
  return PanelKernel<xsimd::sse2, std::uint16_t>::functions();
}

PanelKernels floatKernelsSse2() {
  return PanelKernel<xsimd::sse2, float>::functions();
}

}  // namespace vibe
