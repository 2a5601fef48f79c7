#include "track/normal_equations.hpp"

#include <algorithm>

#include "track/float_sums.hpp"

namespace vibe {
namespace {

constexpr std::size_t kPart = 256;  // rows summed in single precision before they are added in double precision

/// Products of one column with two others.
void dotTwo(const float* a, const float* b, const float* c, std::size_t count, double& ab, double& ac) {
  Four b0{}, b1{}, c0{}, c1{};
  for (std::size_t i = 0; i < count; i += kLanes) {
    const Four p = loadFour(a + i), q = loadFour(a + i + 4);
    b0 += p * loadFour(b + i), b1 += q * loadFour(b + i + 4);
    c0 += p * loadFour(c + i), c1 += q * loadFour(c + i + 4);
  }
  ab += total(b0, b1);
  ac += total(c0, c1);
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
  double spare = 0;
  for (std::size_t begin = 0; begin < count; begin += kPart) {
    const std::size_t rows = std::min(kPart, count - begin);
    for (int a = 0; a < count_; ++a) {
      const float* p = column(a) + begin;
      dotTwo(p, p, residual() + begin, rows, products_(a, a), products_(a, kMaxColumns));
      for (int b = a + 1; b < count_; b += 2) {
        const bool single = b + 1 == count_;
        dotTwo(p, column(b) + begin, single ? p : column(b + 1) + begin, rows, products_(a, b),
               single ? spare : products_(a, b + 1));
      }
    }
  }
}

}  // namespace vibe
