#pragma once
#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "output/result_row.hpp"
#include "suture/suture_session.hpp"
#include "suture/wall_plan.hpp"

namespace vibe::benchmarks {

/// One set of a scenario. The runs differ only in time. Other load on the machine makes a step slower, never faster, so
/// the minimum over the runs counts for each step. `median` is that of the runs, step by step.
struct ScenarioRow {
  SewnSet set;
  StepTimes pulling, after;   ///< CPU of the thread that steps
  double pulling_median = 0;  ///< mean over the steps of the runs' medians [ms]
  double pulling_wall = 0;    ///< mean of the wall time [ms]
};

struct ScenarioResult {
  std::string name;
  double reference = 0;  ///< solver ms per frame that the ViBE prototype reports
  std::vector<ScenarioRow> rows;
  double real_time_factor = 0;  ///< simulated time over the wall time of the sets, all steps of one thread in sequence
  bool crossed = false;         ///< whether the walls intersect at the end
  std::uint64_t state_hash = 0;
};

/// Sews all sets of a layout on a model, `repeats` times.
/// @throws Error if the runs do not end with the same bits
ScenarioResult runScenario(const std::shared_ptr<const Model>& model, const SetLayout& layout, const std::string& name,
                           int repeats, std::ostream& log);

void writeScenarios(const std::vector<ScenarioResult>& results, std::ostream& out);  ///< CSV, a line per set

}  // namespace vibe::benchmarks
