#pragma once
#include "report.hpp"

namespace vibe {

struct BenchOptions {
  int frames = 200;  ///< per seed
  std::vector<std::uint64_t> seeds = {1, 2, 3};
  int bound_stride = 10;  ///< every how many frames the Cramer-Rao bound is computed
  ScoreLimits limits;
  bool tags = true;  ///< false: own trackers and the centroid only
};

/// Renders the frames of a cell, seed by seed, and lets all methods look at the same ones.
CellResult runCell(const Cell& cell, const BenchOptions& options);

}  // namespace vibe
