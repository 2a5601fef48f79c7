#include "sparse/panel_pack.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace vibe {
namespace {

std::uint32_t bits(float value) {
  std::uint32_t result = 0;
  std::memcpy(&result, &value, sizeof(result));
  return result;
}

constexpr std::uint32_t kSmallestNormalHalf = 113U << 23;  // 2^-14, as the bits of a float
constexpr int kLargestExponent = 14;  // scaled columns reach at most 2^14: a quarter of the range of a half

// rounds to nearest even; for values below 2^15, with subnormal results flushed to zero, so that no branch is needed
std::uint16_t toHalf(float value) {
  const std::uint32_t magnitude = bits(value) & 0x7fffffffU;
  const std::uint32_t rounded = magnitude + 0xfffU + (magnitude >> 13 & 1U);
  const std::uint32_t half = (rounded >> 13) - (112U << 10) + (bits(value) >> 16 & 0x8000U);
  return static_cast<std::uint16_t>(magnitude < kSmallestNormalHalf ? 0U : half);
}

/// One column of a panel during the conversion from double to the storage format. The loops are written for
/// auto-vectorisation.
template <class Number>
struct Column {
  std::vector<Number> numbers;

  template <class Real>
  float take(const Real* from, int count) {
    numbers.resize(count);
    for (int i = 0; i < count; ++i) numbers[i] = static_cast<Number>(from[i]);
    return 1;
  }
};

template <>
struct Column<std::uint16_t> {
  std::vector<std::uint16_t> numbers;
  std::vector<float> rounded;

  // The scale is a power of two, so scaling is exact. It prevents overflow of the column, and the loss by flushing
  // subnormals is less than 2^-27 of the largest number in the column.
  template <class Real>
  float take(const Real* from, int count) {
    numbers.resize(count);
    rounded.resize(count);
    float* single = rounded.data();
    for (int i = 0; i < count; ++i) single[i] = static_cast<float>(from[i]);
    std::int32_t largest = 0;  // the bit patterns of positive floats are ordered like their values
    for (int i = 0; i < count; ++i)
      largest = std::max(largest, static_cast<std::int32_t>(bits(single[i]) & 0x7fffffffU));
    const int exponent = (largest >> 23) - 127 + 1 - kLargestExponent;
    const float scale = std::ldexp(1.0F, exponent), factor = std::ldexp(1.0F, -exponent);
    std::uint16_t* half = numbers.data();
    for (int i = 0; i < count; ++i) half[i] = toHalf(single[i] * factor);
    return scale;
  }
};

}  // namespace

template <class Real, class Number>
void packPanel(const FrontPanel<Real>& panel, const PanelStep& step, Number* to, float* column_scale) {
  thread_local Column<Number> column;
  const int rows = step.row_blocks * kTile;
  for (int first = 0; first < step.columns; first += kTile) {
    const int width = std::min(kTile, step.columns - first);
    for (int j = 0; j < width; ++j) {
      column_scale[first + j] = column.take(panel.numbers + (first + j) * panel.stride + first, rows - first);
      const Number* from = column.numbers.data();
      Number* block = to + j * kTile;
      for (int row = first; row < rows; row += kTile, from += kTile, block += width * kTile)
        std::memcpy(block, from, kTile * sizeof(Number));
    }
    to += width * (rows - first);
  }
}

template void packPanel(const FrontPanel<float>&, const PanelStep&, std::uint16_t*, float*);
template void packPanel(const FrontPanel<double>&, const PanelStep&, std::uint16_t*, float*);
template void packPanel(const FrontPanel<double>&, const PanelStep&, float*, float*);
template void packPanel(const FrontPanel<double>&, const PanelStep&, double*, float*);

}  // namespace vibe
