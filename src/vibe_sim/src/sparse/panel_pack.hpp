#pragma once

#include <cstdint>

#include "multifrontal.hpp"

namespace vibe {

/// Writes a panel in the order of PanelStep; column_scale gets one number per column.
void packPanel(const DoublePanel& panel, const PanelStep& step, std::uint16_t* to, float* column_scale);
void packPanel(const DoublePanel& panel, const PanelStep& step, float* to, float* column_scale);
void packPanel(const DoublePanel& panel, const PanelStep& step, double* to, float* column_scale);

/// To half precision (IEEE 754 binary16), to nearest even; |value| < 32768. What would be subnormal becomes zero: some
/// processors convert subnormal numbers slowly.
std::uint16_t toHalf(float value);

}  // namespace vibe
