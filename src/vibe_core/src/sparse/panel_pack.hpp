#pragma once

#include <cstdint>

#include "sparse/multifrontal.hpp"

namespace vibe {

/// Writes a panel in the order of PanelStep; column_scale gets one number per column. Halves are IEEE 754 binary16
/// without subnormal numbers, which some processors convert slowly; these become zero.
void packPanel(const DoublePanel& panel, const PanelStep& step, std::uint16_t* to, float* column_scale);
void packPanel(const DoublePanel& panel, const PanelStep& step, float* to, float* column_scale);
void packPanel(const DoublePanel& panel, const PanelStep& step, double* to, float* column_scale);

}  // namespace vibe
