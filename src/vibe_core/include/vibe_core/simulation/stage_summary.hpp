#pragma once
#include <array>
#include <string>

#include "vibe_core/clocks/step_stages.hpp"
#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_core/model/tissue_solver.hpp"

namespace vibe {

/// What steps have spent their time on, and how much there was to do.
class StageSummary {
 public:
  /// @param report  of a step whose stages were measured
  void add(const StepReport& report);
  /// A table: mean, median and 99th percentile per stage and step, share of the whole; mean counts; and in how many of
  /// 1,000 steps each way was taken.
  std::string text() const;

  /// CPU time of a stage, one entry per step [s].
  const DurationHistogram& stage(StepStage stage) const { return stages_[static_cast<std::size_t>(stage)]; }
  int steps(StepWay way) const { return ways_[static_cast<std::size_t>(way)]; }  ///< that took a way
  const DurationHistogram& whole() const { return whole_; }  ///< of all stages together, one entry per step [s]

 private:
  std::array<DurationHistogram, kStepStages> stages_;
  DurationHistogram whole_;
  double iterations_ = 0, evaluations_ = 0, rows_ = 0, wall_pairs_ = 0;  // sums
  std::array<int, kStepWayCount> ways_{};                                // steps that took them
};

}  // namespace vibe
