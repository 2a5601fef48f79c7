#include "solver/contact_problem.hpp"

#include <algorithm>
#include <cmath>

namespace vibe {

void DenseLu::resize(int n) {
  n_ = n;
  a_.assign(static_cast<std::size_t>(n) * static_cast<std::size_t>(n), 0.0);
  pivot_.resize(static_cast<std::size_t>(n));
}

// Columns [from, to) of the rows from `from` on, with the pivots in them.
bool DenseLu::factorPanel(int from, int to) {
  for (int k = from; k < to; ++k) {
    int best = k;
    for (int i = k + 1; i < n_; ++i)
      if (std::abs(row(i)[k]) > std::abs(row(best)[k])) best = i;
    if (!(std::abs(row(best)[k]) > 0) || !std::isfinite(row(best)[k])) return false;
    pivot_[static_cast<std::size_t>(k)] = best;
    if (best != k) std::swap_ranges(row(k), row(k) + n_, row(best));
    const double* const pivot = row(k);
    for (int i = k + 1; i < n_; ++i) {
      double* const to_row = row(i);
      const double factor = to_row[k] /= pivot[k];
      for (int j = k + 1; j < to; ++j) to_row[j] -= factor * pivot[j];
    }
  }
  return true;
}

// The columns behind a panel: first its own rows, then those below, with all of its rows at once.
void DenseLu::update(int from, int to) {
  for (int k = from + 1; k < to; ++k)
    for (int p = from; p < k; ++p) {
      const double factor = row(k)[p];
      for (int j = to; j < n_; ++j) row(k)[j] -= factor * row(p)[j];
    }
  if (to - from < kPanel) return;  // it is the last one
  kernels_.eliminateFour(a_.data(), n_, to);
}

bool DenseLu::factor() {
  for (int from = 0; from < n_; from += kPanel) {
    const int to = std::min(n_, from + kPanel);
    if (!factorPanel(from, to)) return false;
    update(from, to);
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
