#pragma once

#include <vector>

#include "score.hpp"
#include "vibe_core/common/step_timer.hpp"  // threadCpuTime()

namespace vibe::vision {

/// Keeps the calling thread on the processor it runs on. @return false where the system does not allow it
bool pinThread();

/// Of a set of times, all in the same unit; NaN for an empty set.
struct TimeSummary {
  double least = 0, median = 0;
};
TimeSummary summarise(std::vector<double> times);

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
