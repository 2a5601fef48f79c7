#include "arithmetic/ordered_algebra.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vibe {

namespace {

using Eigen::Index;

constexpr Index kPanel = 8;           // unknowns of a triangular system that are eliminated together
constexpr Index kAllColumns = 128;    // a product with fewer columns adds up all of them at once
constexpr Index kLargeStride = 4000;  // of a matrix whose columns are added up in small groups

/// Even and odd terms are added up apart.
double dotInPairs(const double* a, const double* b, Index n) {
  const Index paired = n / 2 * 2;
  double even = 0, odd = 0;
  for (Index i = 0; i < paired; i += 2) even += a[i] * b[i], odd += a[i + 1] * b[i + 1];
  double sum = even + odd;
  if (paired < n) sum += a[paired] * b[paired];
  return sum;
}

/// Every fourth term is added up apart.
double dotInFours(const double* a, const double* b, Index n) {
  const Index paired = n / 2 * 2, four = n / 4 * 4;
  if (n < 2) return n == 0 ? 0 : a[0] * b[0];
  double s0 = a[0] * b[0], s1 = a[1] * b[1];
  if (paired > 2) {
    double s2 = a[2] * b[2], s3 = a[3] * b[3];
    for (Index i = 4; i < four; i += 4) {
      s0 += a[i] * b[i], s1 += a[i + 1] * b[i + 1];
      s2 += a[i + 2] * b[i + 2], s3 += a[i + 3] * b[i + 3];
    }
    s0 += s2, s1 += s3;
    if (paired > four) s0 += a[four] * b[four], s1 += a[four + 1] * b[four + 1];
  }
  double sum = s0 + s1;
  if (paired < n) sum += a[paired] * b[paired];
  return sum;
}

/// Rows of a product side by side, each in its order.
template <Index kRows>
void addRows(const MatrixView& a, Index row, Index begin, Index end, const VectorView& x, double factor,
             Eigen::Ref<Eigen::VectorXd> out) {
  double sum[kRows] = {};
  for (Index j = begin; j < end; ++j) {
    const double* const column = &a.coeffRef(row, j);
    for (Index r = 0; r < kRows; ++r) sum[r] += column[r] * x[j];
  }
  for (Index r = 0; r < kRows; ++r) out[row + r] += factor * sum[r];
}

void addColumns(const MatrixView& a, const VectorView& x, double factor, Eigen::Ref<Eigen::VectorXd> out) {
  for (Index j = 0; j < a.cols(); ++j) out[j] += factor * dotInPairs(&a.coeffRef(0, j), x.data(), a.rows());
}

}  // namespace

double orderedDot(const VectorView& a, const VectorView& b) {
  return dotInFours(a.data(), b.data(), a.size());
}

void addProduct(const MatrixView& a, const VectorView& x, double factor, Eigen::Ref<Eigen::VectorXd> out) {
  const Index columns = a.cols();
  const bool at_once = columns < kAllColumns || a.rows() == 1;
  const Index group = at_once ? columns : a.outerStride() < kLargeStride ? 16 : 4;
  for (Index begin = 0; begin < columns; begin += group) {
    const Index end = std::min(columns, begin + group);
    Index i = 0;
    for (; i + 16 <= a.rows(); i += 16) addRows<16>(a, i, begin, end, x, factor, out);
    for (; i + 4 <= a.rows(); i += 4) addRows<4>(a, i, begin, end, x, factor, out);
    for (; i < a.rows(); ++i) addRows<1>(a, i, begin, end, x, factor, out);
  }
}

void addTransposedProduct(const MatrixView& a, const VectorView& x, double factor, Eigen::Ref<Eigen::VectorXd> out) {
  if (a.cols() == 1)
    out[0] += factor * dotInFours(a.data(), x.data(), a.rows());
  else
    addColumns(a, x, factor, out);
}

/// Row and column `largest` change places with row and column k of the symmetric rest.
void OrderedLdlt::bringUp(Index k, Index largest) {
  swapped_[static_cast<std::size_t>(k)] = largest;
  if (largest == k) return;
  const Index after = l_.rows() - largest - 1;
  l_.row(k).head(k).swap(l_.row(largest).head(k));
  l_.col(k).tail(after).swap(l_.col(largest).tail(after));
  std::swap(l_(k, k), l_(largest, largest));
  for (Index i = k + 1; i < largest; ++i) std::swap(l_(i, k), l_(largest, i));
}

void OrderedLdlt::compute(const Eigen::MatrixXd& symmetric) {
  l_ = symmetric;
  const Index n = l_.rows();
  temporary_.resize(n);
  swapped_.resize(static_cast<std::size_t>(n));
  positive_ = succeeded_ = true;
  bool found_zero = false;
  for (Index k = 0; k < n; ++k) {
    Index largest = k;
    for (Index i = k + 1; i < n; ++i)
      if (std::abs(l_(i, i)) > std::abs(l_(largest, largest))) largest = i;
    bringUp(k, largest);
    const Index below = n - k - 1;
    double taken = 0;
    for (Index j = 0; j < k; ++j) {
      temporary_[j] = l_(j, j) * l_(k, j);
      taken = j == 0 ? l_(k, j) * temporary_[j] : taken + l_(k, j) * temporary_[j];
    }
    if (k > 0) {
      l_(k, k) -= taken;
      addProduct(l_.block(k + 1, 0, below, k), temporary_.head(k), -1, l_.col(k).tail(below));
    }
    const double pivot = l_(k, k);
    positive_ = positive_ && !(pivot < 0);
    if (std::abs(pivot) > 0) {
      l_.col(k).tail(below) /= pivot;
      succeeded_ = succeeded_ && !found_zero;
    } else {
      found_zero = true;
      succeeded_ = succeeded_ && (l_.col(k).tail(below).array() == 0).all();
    }
  }
}

void OrderedLdlt::solveLower(Eigen::Ref<Eigen::VectorXd> b) const {
  const Index n = l_.rows();
  for (Index begin = 0; begin < n; begin += kPanel) {
    const Index end = std::min(n, begin + kPanel);
    for (Index i = begin; i < end; ++i)
      for (Index k = i + 1; k < end && b[i] != 0; ++k) b[k] -= b[i] * l_(k, i);
    addProduct(l_.block(end, begin, n - end, end - begin), b.segment(begin, end - begin), -1, b.tail(n - end));
  }
}

void OrderedLdlt::solveUpper(Eigen::Ref<Eigen::VectorXd> b) const {
  const Index n = l_.rows();
  for (Index end = n; end > 0; end -= std::min(end, kPanel)) {
    const Index begin = std::max<Index>(0, end - kPanel);
    addColumns(l_.block(end, begin, n - end, end - begin), b.tail(n - end), -1, b.segment(begin, end - begin));
    for (Index i = end - 2; i >= begin; --i) b[i] -= dotInFours(&l_(i + 1, i), &b[i + 1], end - i - 1);
  }
}

void OrderedLdlt::solve(Eigen::Ref<Eigen::VectorXd> b) const {
  const Index n = l_.rows();
  for (Index k = 0; k < n; ++k) std::swap(b[k], b[swapped_[static_cast<std::size_t>(k)]]);
  solveLower(b);
  for (Index i = 0; i < n; ++i) {
    if (std::abs(l_(i, i)) > std::numeric_limits<double>::min())
      b[i] /= l_(i, i);
    else
      b[i] = 0;
  }
  solveUpper(b);
  for (Index k = n - 1; k >= 0; --k) std::swap(b[k], b[swapped_[static_cast<std::size_t>(k)]]);
}

}  // namespace vibe
