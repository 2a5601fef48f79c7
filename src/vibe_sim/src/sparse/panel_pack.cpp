#include "panel_pack.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace vibe {
namespace {

constexpr float kSmallestNormalHalf = 0x1p-14F;
constexpr int kLargestExponent = 14;  // scaled columns reach at most 2^14: a quarter of what a half holds

// A power of two, so that scaling rounds nothing. With it no column overflows a half, and what is lost as subnormal is
// less than 2^-27 of the column's largest number.
double columnScale(const double* column, int rows, std::uint16_t) {
  double largest = 0;
  for (int i = 0; i < rows; ++i) largest = std::max(largest, std::abs(column[i]));
  return largest > 0 ? std::ldexp(1.0, std::ilogb(largest) + 1 - kLargestExponent) : 1.0;
}
template <class Number>
double columnScale(const double*, int, Number) {
  return 1.0;
}

void convert(double value, std::uint16_t& to) {
  to = toHalf(static_cast<float>(value));
}
template <class Number>
void convert(double value, Number& to) {
  to = static_cast<Number>(value);
}

template <class Number>
void pack(const DoublePanel& panel, const PanelStep& step, Number* to, float* column_scale) {
  const int rows = step.row_blocks * kTile;
  for (int first = 0; first < step.columns; first += kTile) {
    const int width = std::min(kTile, step.columns - first);
    for (int j = 0; j < width; ++j) {
      const double* column = panel.numbers + (first + j) * panel.stride;
      const double scale = columnScale(column + first, rows - first, Number());
      const double factor = 1 / scale;
      column_scale[first + j] = static_cast<float>(scale);
      Number* block = to + j * kTile;
      for (int row = first; row < rows; row += kTile, block += width * kTile)
        for (int i = 0; i < kTile; ++i) convert(column[row + i] * factor, block[i]);
    }
    to += width * (rows - first);
  }
}

}  // namespace

std::uint16_t toHalf(float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  const std::uint32_t sign = bits >> 16 & 0x8000U, magnitude = bits & 0x7fffffffU;
  const std::uint32_t rounded = magnitude + 0xfffU + (magnitude >> 13 & 1U);
  const std::uint32_t half = sign | ((rounded >> 13) - (112U << 10));
  return static_cast<std::uint16_t>(std::abs(value) < kSmallestNormalHalf ? 0U : half);
}

void packPanel(const DoublePanel& panel, const PanelStep& step, std::uint16_t* to, float* column_scale) {
  pack(panel, step, to, column_scale);
}
void packPanel(const DoublePanel& panel, const PanelStep& step, float* to, float* column_scale) {
  pack(panel, step, to, column_scale);
}
void packPanel(const DoublePanel& panel, const PanelStep& step, double* to, float* column_scale) {
  pack(panel, step, to, column_scale);
}

}  // namespace vibe
