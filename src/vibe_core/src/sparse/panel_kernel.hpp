#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "arithmetic/kernel_path.hpp"

namespace vibe {

/// One supernode of c columns and n rows (its own c and those below) in the layout of the kernels. Its panel W holds [
/// L11^-1 ; -L21 L11^-1 ] with every column scaled to use the range of half precision, so that both substitutions are
/// one product:
///   forward  [y1; y2] = [0; y2] + W y1,  backward  y1 = Wt [y1; y2].
/// Storage order: tiles of 8 columns (the last may have fewer), ascending; within a tile blocks of 8 rows, ascending,
/// starting at the block of the tile's first row (above it W is zero); within a block the columns; within a column its
/// 8 rows. The rows are padded with zeros to whole blocks. The kernels read in this order, forwards and backwards.
struct PanelStep {
  std::int32_t first_row;    ///< scalar, of the whole vector
  std::int32_t columns;      ///< c
  std::int32_t row_blocks;   ///< n / 8, rounded up
  std::int32_t below_nodes;  ///< rows below the supernode, in nodes
  std::int64_t first_index;  ///< into row_index: first scalar row of each node below
  std::int64_t panel;        ///< first number; a multiple of 64
};

constexpr int kTile = 8;

/// Number of entries in a panel.
constexpr std::int64_t panelSize(std::int64_t columns, std::int64_t row_blocks) {
  const std::int64_t tiles = columns / kTile, rest = columns % kTile;
  return kTile * (kTile * (tiles * row_blocks - tiles * (tiles - 1) / 2) + rest * (row_blocks - tiles));
}

/// A non-owning view of a factor or of a part of it, for kernels that must not instantiate code of shared containers.
struct PanelSet {
  const PanelStep* steps;
  int step_count;
  const std::int32_t* row_index;
  const void* numbers;
  const float* column_scale;  ///< W = panel * diag(column_scale), one per row of the vector
  std::ptrdiff_t ahead;       ///< prefetch distance [bytes]
  /// What the forward substitution adds to rows from here on is recorded instead, in order (3 per node).
  std::int32_t end_row = std::numeric_limits<std::int32_t>::max();
  float* record = nullptr;
};

/// Blocks of 8 rows, or tiles of 8 columns, past the last.
struct BlockRange {
  int first, last;
};

/// The operations of a kernel on one vector, or on three interleaved ones (x0 y0 z0 x1 ...). `work` holds the rows of
/// the largest supernode in whole blocks, three times for `path`.
struct PanelKernels {
  void (*forward)(const PanelSet& set, float* vector, float* work);
  void (*backward)(const PanelSet& set, float* vector, float* work);
  /// One step of the forward substitution of three vectors whose rows before `from` are zero.
  void (*stepOfThree)(const PanelSet& set, int step, int from, float* vectors, float* work);
  /// Some rows of a step's product W y1 [8 per block], to `work`; the parts of a step are independent of each other.
  void (*forwardRows)(const PanelSet& set, int step, BlockRange rows, const float* own, float* work);
  /// Some columns of a step's product Wt work, to their rows of the vector; the parts are independent too.
  void (*backwardTiles)(const PanelSet& set, int step, BlockRange tiles, const float* work, float* vector);
};

PanelKernels halfKernels(KernelPath path);
PanelKernels floatKernels(KernelPath path);
PanelKernels doubleKernels();  ///< panel in double, vectors in float

/// Both substitutions in double precision.
void solveDouble(const PanelSet& set, double* vector, double* work);

/// Of a register tile; a tile's rows fill a cache line.
template <class Real>
constexpr int kDenseRows = 64 / static_cast<int>(sizeof(Real));
constexpr int kDenseColumns = 6;

/// C -= A B for the 6 columns of C from `c` on, column-major with column stride `stride`, and kDenseRows rows per row
/// panel. A: row panels in sequence, each with `depth` columns of kDenseRows numbers. B: `depth` rows of 6 numbers.
template <class Real>
using DenseUpdate = void (*)(const Real* a, int row_panels, const Real* b, int depth, Real* c, std::int64_t stride);

/// @tparam Real  float or double
template <class Real>
DenseUpdate<Real> denseUpdate(KernelPath path);
template <>
DenseUpdate<float> denseUpdate(KernelPath path);
template <>
DenseUpdate<double> denseUpdate(KernelPath path);

}  // namespace vibe
