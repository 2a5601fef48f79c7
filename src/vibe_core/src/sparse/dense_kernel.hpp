#pragma once

#include <cstdint>

#include "sparse/panel_kernel.hpp"

namespace vibe {

constexpr int kDenseRows = 8, kDenseColumns = 6;  // of a register tile

/// C -= A B for the 6 columns of C from `c` on, column-major with column stride `stride`, and 8 rows per row panel. A:
/// row panels in sequence, each with `depth` columns of 8 numbers. B: `depth` rows of 6 numbers.
using DenseUpdate = void (*)(const double* a, int row_panels, const double* b, int depth, double* c,
                             std::int64_t stride);

DenseUpdate denseUpdate(InstructionPath path);

}  // namespace vibe
