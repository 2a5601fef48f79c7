#include "vibe_core/simulation/stage_summary.hpp"

#include <numeric>

#include "vibe_core/files/number_text.hpp"

namespace vibe {

void StageSummary::add(const StepReport& report) {
  for (std::size_t k = 0; k < stages_.size(); ++k) stages_[k].add(report.stage_times[k]);
  whole_.add(std::accumulate(report.stage_times.begin(), report.stage_times.end(), 0.0));
  iterations_ += report.iterations;
  evaluations_ += report.evaluations;
  rows_ += report.rows;
  wall_pairs_ += report.wall_pairs;
  for (std::size_t k = 0; k < kStepWayCount; ++k) ways_[k] += report.ways.of(static_cast<StepWay>(k)) > 0 ? 1 : 0;
}

std::string StageSummary::text() const {
  const double steps = static_cast<double>(whole_.count());
  if (steps == 0) return "";
  std::string text = "stage     ms per step    p50    p99   share\n";
  const auto add = [&](const char* name, const DurationHistogram& times) {
    text += formatted("%-10s%11.3f%7.3f%7.3f%6.1f %%\n", name, 1e3 * times.mean(), 1e3 * times.quantile(0.5),
                      1e3 * times.quantile(0.99), 100 * times.mean() / whole_.mean());
  };
  for (int k = 0; k < kStepStages; ++k) add(toString(static_cast<StepStage>(k)), stages_[static_cast<std::size_t>(k)]);
  add("all", whole_);
  text += formatted("per step: %.2f iterations, %.2f evaluations, %.1f rows, %.1f pairs of walls\n",
                    iterations_ / steps, evaluations_ / steps, rows_ / steps, wall_pairs_ / steps);
  text += "ways per 1,000 steps (docs/computation.md):";
  const char* separator = " ";
  for (std::size_t k = 0; k < kStepWayCount; ++k) {
    if (ways_[k] == 0) continue;
    text += formatted("%s%s %.1f", separator, nameOf(static_cast<StepWay>(k)), 1e3 * ways_[k] / steps);
    separator = ", ";
  }
  return text + "\n";
}

}  // namespace vibe
