#pragma once
#include <ostream>
#include <vector>

#include "bench_scene.hpp"
#include "score.hpp"

namespace vibe::vision {

struct CellResult {
  Cell cell;
  std::vector<Score> scores;  ///< by method
  TimeSummary track, search;  ///< one tracker for both instruments, per frame [s]
};

/// The table for people: one line per method.
void printHeader(std::ostream& out, const ScoreLimits& limits);
void printCell(std::ostream& out, const CellResult& result);
/// One row per cell and method, SI units except pixels.
void writeCsv(std::ostream& out, const std::vector<CellResult>& results);

}  // namespace vibe::vision
