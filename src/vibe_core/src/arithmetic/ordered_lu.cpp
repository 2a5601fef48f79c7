#include "arithmetic/ordered_lu.hpp"

#include <algorithm>
#include <cmath>

namespace vibe {

namespace {

using Eigen::Index;
using Block = Eigen::Ref<Eigen::MatrixXd>;

constexpr Index kUnblocked = 16;  // columns of a matrix that is not divided
constexpr Index kBlock = 8;       // columns of a larger one that are eliminated together
constexpr Index kTriangle = 4;    // unknowns of a triangular system that are eliminated together
constexpr Index kSmall = 6;       // rows of a rest in which all products are added up in their order

/// The sum of a(i, k) b(k, j), k from begin to end.
double rowTimesColumn(const Block& a, Index i, const Block& b, Index j, Index begin, Index end) {
  double sum = 0;
  for (Index k = begin; k < end; ++k) sum += a(i, k) * b(k, j);
  return sum;
}

/// The same; even and odd terms are added up apart.
double rowTimesColumnInPairs(const Block& a, Index i, const Block& b, Index j, Index begin, Index end) {
  double even = 0, odd = 0;
  for (Index k = begin; k < end; k += 2) even += a(i, k) * b(k, j), odd += a(i, k + 1) * b(k + 1, j);
  return even + odd;
}

/// Columns begin to end of all rows from begin on; rows of b change places with those of A.
void eliminate(Block& a, Block& b, Index begin, Index end) {
  const Index n = a.rows();
  for (Index k = begin; k < end; ++k) {
    Index largest = k;
    for (Index i = k + 1; i < n; ++i)
      if (std::abs(a(i, k)) > std::abs(a(largest, k))) largest = i;
    if (a(largest, k) != 0) {
      if (largest != k) a.row(k).swap(a.row(largest)), b.row(k).swap(b.row(largest));
      a.col(k).tail(n - k - 1) /= a(k, k);
    }
    for (Index j = k + 1; j < end; ++j)
      for (Index i = k + 1; i < n; ++i) a(i, j) -= a(i, k) * a(k, j);
  }
}

/// Column j of x by the rows and columns of L from begin to end.
void solveLower(const Block& l, Block& x, Index j, Index begin, Index end) {
  for (Index panel = begin; panel < end; panel += kTriangle) {
    const Index next = std::min(end, panel + kTriangle);
    for (Index k = panel; k < next; ++k)
      for (Index i = k + 1; i < next; ++i) x(i, j) -= x(k, j) * l(i, k);
    for (Index i = next; i < end; ++i) x(i, j) -= rowTimesColumn(l, i, x, j, panel, next);
  }
}

void solveUpper(const Block& u, Block& x, Index j) {
  for (Index end = u.rows(); end > 0; end -= std::min(end, kTriangle)) {
    const Index begin = std::max<Index>(0, end - kTriangle);
    for (Index k = end - 1; k >= begin; --k) {
      x(k, j) *= 1 / u(k, k);
      for (Index i = begin; i < k; ++i) x(i, j) -= x(k, j) * u(i, k);
    }
    for (Index i = 0; i < begin; ++i) x(i, j) -= rowTimesColumn(u, i, x, j, begin, end);
  }
}

/// What the eliminated columns begin to end take from the rest of A.
void updateRest(Block& a, Index begin, Index end) {
  const Index n = a.rows(), rest = n - end, fours = rest / 4 * 4;
  const Index pair = rest < kSmall || rest % 4 < 2 ? n : end + fours;  // two rows that are left of groups of four
  for (Index j = end; j < n; ++j) {
    solveLower(a, a, j, begin, end);
    for (Index i = end; i < n; ++i) {
      const bool in_pairs = i >= pair && i < pair + 2 && j < end + fours;
      a(i, j) -= in_pairs ? rowTimesColumnInPairs(a, i, a, j, begin, end) : rowTimesColumn(a, i, a, j, begin, end);
    }
  }
}

}  // namespace

void solveByOrderedLu(Eigen::Ref<Eigen::MatrixXd> a, Eigen::Ref<Eigen::MatrixXd> b) {
  const Index n = a.rows(), block = n > kUnblocked ? kBlock : n;
  for (Index begin = 0; begin < n; begin += block) {
    const Index end = std::min(n, begin + block);
    eliminate(a, b, begin, end);
    updateRest(a, begin, end);
  }
  for (Index j = 0; j < b.cols(); ++j) {
    solveLower(a, b, j, 0, n);
    solveUpper(a, b, j);
  }
}

}  // namespace vibe
