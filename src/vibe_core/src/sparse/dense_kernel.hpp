#pragma once

#include <cstdint>

#include "sparse/panel_kernel.hpp"

namespace vibe {

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

}  // namespace vibe
