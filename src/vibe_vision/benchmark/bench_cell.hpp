#pragma once

#include <vector>

#include "score.hpp"

namespace vibe::vision {

struct BenchOptions {
  int frames = 200;  ///< per seed
  std::vector<std::uint64_t> seeds = {1, 2, 3};
  int bound_stride = 10;  ///< every how many frames the Cramer-Rao bound is computed
  ScoreLimits limits;
  std::ostream* trace = nullptr;     ///< gets one line of CSV per frame and method; null: none
  std::vector<std::string> methods;  ///< empty: all
};

/// Of the lines of BenchOptions::trace.
void writeTraceHeader(std::ostream& out);

/// Renders the frames of a cell, seed by seed, and lets all methods look at the same ones.
CellResult runCell(const Cell& cell, const BenchOptions& options);

}  // namespace vibe::vision
