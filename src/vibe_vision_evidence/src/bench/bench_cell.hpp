#pragma once

#include <ostream>
#include <vector>

#include "bench/score.hpp"

namespace vibe::vision::evidence {

struct BenchOptions {
  int frames = 200;  ///< per seed
  std::vector<std::uint64_t> seeds = {1, 2, 3};
  int bound_stride = 10;  ///< every how many frames the Cramer-Rao bound is computed
  ScoreLimits limits;
  std::vector<std::string> methods;  ///< empty: all
};

/// The first frames of a scene of a cell, as all methods see them.
std::vector<RenderedFrame> renderFrames(const BenchScene& scene, const Cell& cell, int count);

struct CellResult {
  Cell cell;
  std::vector<Score> scores;  ///< by method
  TimeSummary track, search;  ///< one tracker for both instruments, per frame [s]
};

/// Renders the frames of a cell, seed by seed, and lets all methods look at the same ones.
CellResult runCell(const Cell& cell, const BenchOptions& options);
/// One row per cell and method, SI units except pixels; nan where nothing was measured.
void writeCsvHeader(std::ostream& out);
void writeCsv(std::ostream& out, const CellResult& result);

}  // namespace vibe::vision::evidence
