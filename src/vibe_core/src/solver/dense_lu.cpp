#include "solver/dense_lu.hpp"

#include <algorithm>
#include <cmath>

namespace vibe {

void DenseLu::resize(int n) {
  n_ = n;
  a_.assign(static_cast<std::size_t>(n) * static_cast<std::size_t>(n), 0.0);
  pivot_.resize(static_cast<std::size_t>(n));
}

void DenseLu::eliminate(int k) {
  const double* const from = row(k);
  const double inverse = 1 / from[k];
  for (int i = k + 1; i < n_; ++i) {
    double* const to = row(i);
    if (to[k] == 0) continue;
    const double factor = to[k] *= inverse;
    for (int j = k + 1; j < n_; ++j) to[j] -= factor * from[j];
  }
}

bool DenseLu::factor() {
  for (int k = 0; k < n_; ++k) {
    int best = k;
    for (int i = k + 1; i < n_; ++i)
      if (std::abs(row(i)[k]) > std::abs(row(best)[k])) best = i;
    if (!(std::abs(row(best)[k]) > 0) || !std::isfinite(row(best)[k])) return false;
    pivot_[static_cast<std::size_t>(k)] = best;
    if (best != k) std::swap_ranges(row(k), row(k) + n_, row(best));
    eliminate(k);
  }
  return true;
}

void DenseLu::solve(double* b) const {
  for (int k = 0; k < n_; ++k) std::swap(b[k], b[pivot_[static_cast<std::size_t>(k)]]);
  for (int i = 0; i < n_; ++i)
    for (int j = 0; j < i; ++j) b[i] -= row(i)[j] * b[j];
  for (int i = n_ - 1; i >= 0; --i) {
    for (int j = i + 1; j < n_; ++j) b[i] -= row(i)[j] * b[j];
    b[i] /= row(i)[i];
  }
}

}  // namespace vibe
