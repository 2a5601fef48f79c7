#include "track/normal_equations.hpp"

#include <algorithm>
#include <array>

#include "track/lanes.hpp"

namespace vibe::vision {
namespace {

constexpr std::size_t kRowsAtATime = 256;  // rows summed in single precision before they are added in double precision

using Eight [[gnu::vector_size(32), gnu::aligned(4), gnu::may_alias]] = float;
constexpr std::size_t kTogether = 4;  // columns

/// Adds the products of column a with some others to `sums`, in the order of total() of float_sums.hpp.
VIBE_LANES void addProducts(const float* a, const std::array<const float*, kTogether>& others, std::size_t count,
                            std::array<double, kTogether>& sums) {
  const float *p = others[0], *q = others[1], *r = others[2], *s = others[3];
  Eight sum[kTogether] = {};
  for (std::size_t i = 0; i < count; i += kLanes) {
    const Eight v = *reinterpret_cast<const Eight*>(a + i);
    sum[0] += v * *reinterpret_cast<const Eight*>(p + i);
    sum[1] += v * *reinterpret_cast<const Eight*>(q + i);
    sum[2] += v * *reinterpret_cast<const Eight*>(r + i);
    sum[3] += v * *reinterpret_cast<const Eight*>(s + i);
  }
  for (std::size_t k = 0; k < kTogether; ++k) {
    const float* e = reinterpret_cast<const float*>(&sum[k]);
    sums[k] = (static_cast<double>(e[0] + e[4]) + (e[1] + e[5])) + (static_cast<double>(e[2] + e[6]) + (e[3] + e[7]));
  }
}

}  // namespace

NormalEquations::NormalEquations(std::size_t capacity) : capacity_((capacity + kLanes - 1) / kLanes * kLanes) {
  columns_.assign(capacity_ * (kMaxColumns + 1), 0);
  products_.setZero();
}

void NormalEquations::start(int columns) {
  count_ = columns;
  products_.setZero();
}

void NormalEquations::sum(std::size_t count) {
  for (std::size_t begin = 0; begin < count; begin += kRowsAtATime)
    for (int a = 0; a < count_; ++a)
      for (int b = a; b <= count_; b += kTogether) sumGroup(a, b, begin, std::min(kRowsAtATime, count - begin));
}

/// Column a with column b and those behind it; column count_ stands for the residual.
void NormalEquations::sumGroup(int a, int b, std::size_t begin, std::size_t rows) {
  std::array<const float*, kTogether> others;
  std::array<double, kTogether> sums;
  for (int k = 0; k < static_cast<int>(kTogether); ++k)
    others[k] = (b + k < count_ ? column(b + k) : residual()) + begin;
  addProducts(column(a) + begin, others, rows, sums);
  for (int k = 0; k < static_cast<int>(kTogether) && b + k <= count_; ++k)
    products_(a, b + k < count_ ? b + k : kMaxColumns) += sums[k];
}

}  // namespace vibe::vision
