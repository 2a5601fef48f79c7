#include "sparse/front_elimination.hpp"

#include <algorithm>
#include <cmath>

namespace vibe {
namespace {

// For a matrix with a unit diagonal. In double precision smaller pivots are rounding errors; in single precision a few
// rounding errors (6e-8 each) are a thousandth of smaller ones, which is what the storage in half precision loses.
template <class Real>
constexpr Real kSmallestPivot = 1e-14;
template <>
constexpr float kSmallestPivot<float> = 3e-4F;

// In one piece of work. Design choice: in a front of a thousand rows, some ten microseconds.
constexpr int kRowPanels = 8;
constexpr int kColumnPanels = 4;

constexpr int panels(int count, int size) {
  return (count + size - 1) / size;
}

}  // namespace

template <class Real>
FrontElimination<Real>::FrontElimination() : update_(denseUpdate<Real>(kernelPath())) {
  negative_inverse_a_.resize(kBlock * kBlock);
  negative_inverse_b_.resize(kBlock * kBlock);
  lower_.resize(kBlock * kBlock);
  inverse_.resize(kBlock * kBlock);
}

template <class Real>
void FrontElimination<Real>::setLargestFront(int rows) {
  below_.grow(static_cast<std::int64_t>(rows + kDenseRows<Real>) * kBlock);
  own_.grow(static_cast<std::int64_t>(rows + kDenseColumns) * kBlock);
}

template <class Real>
bool FrontElimination<Real>::run(Real* front, int rows, int columns, ThreadPool& pool) {
  pool_ = &pool;
  front_ = front;
  rows_ = rows;
  stride_ = stride(rows);
  for (int first = 0; first < columns; first += kBlock) {
    const int width = std::min(kBlock, columns - first);
    if (!factorDiagonal(first, width)) return false;
    finishOwnRows(first, width);
    eliminateBelow(first, width);
    updateRest(first, width);
  }
  return true;
}

// lower_ and its inverse; every inner loop runs along a column
template <class Real>
bool FrontElimination<Real>::factorDiagonal(int first, int width) {
  Real* l = lower_.data();
  Real* t = inverse_.data();
  for (int j = 0; j < width; ++j) std::copy(at(first + j, first + j), at(first + width, first + j), l + j * kBlock + j);
  for (int j = 0; j < width; ++j) {
    Real* column = l + j * kBlock;
    if (!(column[j] > kSmallestPivot<Real>)) return false;  // also fails for NaN
    const Real root = std::sqrt(column[j]);
    for (int i = j; i < width; ++i) column[i] /= root;
    for (int k = j + 1; k < width; ++k)
      for (int i = k; i < width; ++i) l[k * kBlock + i] -= column[i] * column[k];
  }
  std::fill(t, t + kBlock * kBlock, Real(0));
  for (int j = 0; j < width; ++j) {
    Real* column = t + j * kBlock;
    column[j] = 1;
    for (int k = j; k < width; ++k) {
      column[k] /= l[k * kBlock + k];
      for (int i = k + 1; i < width; ++i) column[i] -= l[k * kBlock + i] * column[k];
    }
  }
  return true;
}

// W for the rows of the block: the inverse of the diagonal block, and its product with the remainder of the previous
// columns
template <class Real>
void FrontElimination<Real>::finishOwnRows(int first, int width) {
  Real* a = negative_inverse_a_.data();
  Real* b = negative_inverse_b_.data();
  const Real* t = inverse_.data();
  std::fill(a, a + kBlock * kBlock, Real(0));
  std::fill(b, b + kBlock * kBlock, Real(0));
  for (int m = 0; m < width; ++m)
    for (int i = m; i < width; ++i) {
      a[i / kDenseRows<Real> * kDenseRows<Real> * width + m * kDenseRows<Real> + i % kDenseRows<Real>] =
          -t[m * kBlock + i];
      b[i / kDenseColumns * kDenseColumns * width + m * kDenseColumns + i % kDenseColumns] = -t[m * kBlock + i];
    }
  packOwn(first, width);
  for (int j = 0; j < first; ++j) std::fill(at(first, j), at(first + width, j), Real(0));
  for (int j = 0; j < first; j += kDenseColumns)
    update_(a, panels(width, kDenseRows<Real>), own_.data() + j * width, width, at(first, j), stride_);
}

// own_ for the columns before the block, from the rows of the block
template <class Real>
void FrontElimination<Real>::packOwn(int first, int width) {
  for (int j = 0; j < first; ++j) {
    const Real* from = at(first, j);
    Real* to = own_.data() + j / kDenseColumns * kDenseColumns * width + j % kDenseColumns;
    for (int m = 0; m < width; ++m) to[m * kDenseColumns] = from[m];
  }
}

// L below the block, overwriting the matrix
template <class Real>
void FrontElimination<Real>::eliminateBelow(int first, int width) {
  const int below = rows_ - first - width;
  packBelow(first, width);
  for (int j = 0; j < width; ++j) std::fill(at(first + width, first + j), at(rows_, first + j), Real(0));
  pool_->parallelFor(panels(width, kDenseColumns), 1, [&](int panel, int) {
    const int j = panel * kDenseColumns;
    update_(below_.data(), panels(below, kDenseRows<Real>), negative_inverse_b_.data() + j * width, width,
            at(first + width, first + j), stride_);
  });
  packBelow(first, width);
}

template <class Real>
void FrontElimination<Real>::packBelow(int first, int width) {
  const int start = first + width, below = rows_ - start;
  pool_->parallelFor(panels(below, kDenseRows<Real>), kRowPanels, [&](int begin, int end) {
    for (int i = begin * kDenseRows<Real>; i < std::min(end * kDenseRows<Real>, below); i += kDenseRows<Real>) {
      Real* to = below_.data() + i * width;
      const int count = std::min(kDenseRows<Real>, below - i);
      for (int m = 0; m < width; ++m, to += kDenseRows<Real>) {
        const Real* from = at(start + i, first + m);
        for (int r = 0; r < kDenseRows<Real>; ++r) to[r] = r < count ? from[r] : Real(0);
      }
    }
  });
}

// own_ for all columns: of the block its inverse, of those after it what is in below_
template <class Real>
void FrontElimination<Real>::packRest(int first, int width) {
  const int start = first + width;
  const auto own_at = [&](int column, int m) -> Real& {
    return own_.data()[column / kDenseColumns * kDenseColumns * width + m * kDenseColumns + column % kDenseColumns];
  };
  packOwn(first, width);
  for (int j = 0; j < width; ++j)
    for (int m = 0; m < width; ++m) own_at(first + j, m) = inverse_.data()[j * kBlock + m];
  pool_->parallelFor(rows_ - start, kRowPanels * kDenseRows<Real>, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const Real* from = below_.data() + i / kDenseRows<Real> * kDenseRows<Real> * width + i % kDenseRows<Real>;
      for (int m = 0; m < width; ++m) own_at(start + i, m) = from[m * kDenseRows<Real>];
    }
  });
  for (int j = rows_; j % kDenseColumns != 0; ++j)
    for (int m = 0; m < width; ++m) own_at(j, m) = 0;
}

template <class Real>
void FrontElimination<Real>::updateRest(int first, int width) {
  const int start = first + width;
  packRest(first, width);
  for (int j = 0; j < width; ++j) {
    std::copy(inverse_.data() + j * kBlock, inverse_.data() + j * kBlock + width, at(first, first + j));
    std::fill(at(start, first + j), at(rows_, first + j), Real(0));
  }
  const int row_panels = panels(rows_ - start, kDenseRows<Real>);
  pool_->parallelFor(panels(rows_, kDenseColumns), kColumnPanels, [&](int begin, int end) {
    for (int j = begin * kDenseColumns; j < std::min(end * kDenseColumns, rows_); j += kDenseColumns) {
      const int skipped = std::max(0, j - start) / kDenseRows<Real>;
      update_(below_.data() + skipped * kDenseRows<Real> * width, row_panels - skipped, own_.data() + j * width, width,
              at(start + skipped * kDenseRows<Real>, j), stride_);
    }
  });
}

template class FrontElimination<float>;
template class FrontElimination<double>;

}  // namespace vibe
