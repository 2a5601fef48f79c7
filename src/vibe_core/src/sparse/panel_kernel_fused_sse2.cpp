#include "sparse/panel_kernel_impl.hpp"

namespace vibe {

PanelKernels halfKernelsFusedSse2() {
  return PanelKernel<FusedSse2, std::uint16_t>::functions();
}

PanelKernels floatKernelsFusedSse2() {
  return PanelKernel<FusedSse2, float>::functions();
}

}  // namespace vibe
