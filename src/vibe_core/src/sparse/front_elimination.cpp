#include "sparse/front_elimination.hpp"

#include <algorithm>
#include <cmath>

namespace vibe {
namespace {

// for a matrix with a unit diagonal; smaller pivots are rounding errors
constexpr double kSmallestPivot = 1e-14;

constexpr int panels(int count, int size) {
  return (count + size - 1) / size;
}

}  // namespace

FrontElimination::FrontElimination() : update_(denseUpdate(bestInstructionPath())) {
  negative_inverse_a_.resize(kBlock * kBlock);
  negative_inverse_b_.resize(kBlock * kBlock);
  lower_.resize(kBlock * kBlock);
  inverse_.resize(kBlock * kBlock);
}

void FrontElimination::setLargestFront(int rows) {
  below_.grow(static_cast<std::int64_t>(rows + kDenseRows) * kBlock);
  own_.grow(static_cast<std::int64_t>(rows + kDenseColumns) * kBlock);
}

bool FrontElimination::run(double* front, int rows, int columns) {
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
bool FrontElimination::factorDiagonal(int first, int width) {
  double* l = lower_.data();
  double* t = inverse_.data();
  for (int j = 0; j < width; ++j) std::copy(at(first + j, first + j), at(first + width, first + j), l + j * kBlock + j);
  for (int j = 0; j < width; ++j) {
    double* column = l + j * kBlock;
    if (!(column[j] > kSmallestPivot)) return false;  // also fails for NaN
    const double root = std::sqrt(column[j]);
    for (int i = j; i < width; ++i) column[i] /= root;
    for (int k = j + 1; k < width; ++k)
      for (int i = k; i < width; ++i) l[k * kBlock + i] -= column[i] * column[k];
  }
  std::fill(t, t + kBlock * kBlock, 0.0);
  for (int j = 0; j < width; ++j) {
    double* column = t + j * kBlock;
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
void FrontElimination::finishOwnRows(int first, int width) {
  double* a = negative_inverse_a_.data();
  double* b = negative_inverse_b_.data();
  const double* t = inverse_.data();
  std::fill(a, a + kBlock * kBlock, 0.0);
  std::fill(b, b + kBlock * kBlock, 0.0);
  for (int m = 0; m < width; ++m)
    for (int i = m; i < width; ++i) {
      a[i / kDenseRows * kDenseRows * width + m * kDenseRows + i % kDenseRows] = -t[m * kBlock + i];
      b[i / kDenseColumns * kDenseColumns * width + m * kDenseColumns + i % kDenseColumns] = -t[m * kBlock + i];
    }
  packOwn(first, width);
  for (int j = 0; j < first; ++j) std::fill(at(first, j), at(first + width, j), 0.0);
  for (int j = 0; j < first; j += kDenseColumns)
    update_(a, panels(width, kDenseRows), own_.data() + j * width, width, at(first, j), stride_);
}

// own_ for the columns before the block, from the rows of the block
void FrontElimination::packOwn(int first, int width) {
  for (int j = 0; j < first; ++j) {
    const double* from = at(first, j);
    double* to = own_.data() + j / kDenseColumns * kDenseColumns * width + j % kDenseColumns;
    for (int m = 0; m < width; ++m) to[m * kDenseColumns] = from[m];
  }
}

// L below the block, overwriting the matrix
void FrontElimination::eliminateBelow(int first, int width) {
  const int below = rows_ - first - width;
  packBelow(first, width);
  for (int j = 0; j < width; ++j) std::fill(at(first + width, first + j), at(rows_, first + j), 0.0);
  for (int j = 0; j < width; j += kDenseColumns)
    update_(below_.data(), panels(below, kDenseRows), negative_inverse_b_.data() + j * width, width,
            at(first + width, first + j), stride_);
  packBelow(first, width);
}

void FrontElimination::packBelow(int first, int width) {
  const int start = first + width, below = rows_ - start;
  for (int i = 0; i < below; i += kDenseRows) {
    double* to = below_.data() + i * width;
    const int count = std::min(kDenseRows, below - i);
    for (int m = 0; m < width; ++m, to += kDenseRows) {
      const double* from = at(start + i, first + m);
      for (int r = 0; r < kDenseRows; ++r) to[r] = r < count ? from[r] : 0.0;
    }
  }
}

void FrontElimination::updateRest(int first, int width) {
  const int start = first + width;
  double* own = own_.data();
  const auto own_at = [&](int column, int m) -> double& {
    return own[column / kDenseColumns * kDenseColumns * width + m * kDenseColumns + column % kDenseColumns];
  };
  packOwn(first, width);
  for (int j = 0; j < width; ++j) {
    for (int m = 0; m < width; ++m) own_at(first + j, m) = inverse_.data()[j * kBlock + m];
    std::copy(inverse_.data() + j * kBlock, inverse_.data() + j * kBlock + width, at(first, first + j));
    std::fill(at(start, first + j), at(rows_, first + j), 0.0);
  }
  for (int i = 0; i < rows_ - start; ++i) {
    const double* from = below_.data() + i / kDenseRows * kDenseRows * width + i % kDenseRows;
    for (int m = 0; m < width; ++m) own_at(start + i, m) = from[m * kDenseRows];
  }
  for (int j = rows_; j % kDenseColumns != 0; ++j)
    for (int m = 0; m < width; ++m) own_at(j, m) = 0;
  const int row_panels = panels(rows_ - start, kDenseRows);
  for (int j = 0; j < rows_; j += kDenseColumns) {
    const int skipped = std::max(0, j - start) / kDenseRows;
    update_(below_.data() + skipped * kDenseRows * width, row_panels - skipped, own + j * width, width,
            at(start + skipped * kDenseRows, j), stride_);
  }
}

}  // namespace vibe
