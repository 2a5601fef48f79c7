#pragma once

#include <cstdint>

#include "sparse/multifrontal.hpp"

namespace vibe {

/// Writes a panel in the order of PanelStep; column_scale gets one number per column. Halves are IEEE 754 binary16
/// without subnormal numbers, which some processors convert slowly; these become zero.
template <class Real, class Number>
void packPanel(const FrontPanel<Real>& panel, const PanelStep& step, Number* to, float* column_scale);

}  // namespace vibe
