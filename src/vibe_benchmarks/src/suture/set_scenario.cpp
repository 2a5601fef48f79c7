#include "suture/set_scenario.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>

#include "suture/wall_crossing.hpp"
#include "vibe_core/common/error.hpp"

namespace vibe::benchmarks {
namespace {

double meanOf(const std::vector<double>& values) {
  return values.empty() ? 0 : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// For each step, the minimum or the median over the runs.
std::vector<double> overRuns(const std::vector<const std::vector<double>*>& runs, bool cheapest) {
  std::vector<double> chosen(runs.front()->size());
  std::vector<double> step(runs.size());
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    for (std::size_t r = 0; r < runs.size(); ++r) step[r] = (*runs[r])[k];
    std::sort(step.begin(), step.end());
    chosen[k] = step[cheapest ? 0 : step.size() / 2];
  }
  return chosen;
}

struct ScenarioRun {
  std::vector<SewnSet> sets;
  std::uint64_t state_hash = 0;
  bool crossed = false;
};

ScenarioRun runOnce(const std::shared_ptr<const Model>& model, const SetLayout& layout, std::ostream& log) {
  SutureSession session(model);
  session.settle();
  const auto spots = planSets(WallPlan(model->organ, session.wall()), layout);
  ScenarioRun run;
  for (const auto& set : spots) {
    run.sets.push_back(session.sew(set));
    const StepTimes times = timesOf(run.sets.back().pulling.cpu);
    log << "  set " << run.sets.size() << ": " << run.sets.back().pulling.cpu.size() << " steps, " << times.mean
        << " ms, at most " << times.max << ", " << run.sets.back().tension << " N" << std::endl;
  }
  run.state_hash = hash(session.state());
  run.crossed = wallsCross(session.model(), session.state());
  return run;
}

ScenarioRow rowOf(const std::vector<ScenarioRun>& runs, std::size_t set) {
  std::vector<const std::vector<double>*> pulling, after, wall;
  for (const ScenarioRun& run : runs) {
    pulling.push_back(&run.sets[set].pulling.cpu);
    after.push_back(&run.sets[set].after.cpu);
    wall.push_back(&run.sets[set].pulling.wall);
  }
  ScenarioRow row;
  row.set = runs.front().sets[set];
  row.pulling = timesOf(overRuns(pulling, true));
  row.after = timesOf(overRuns(after, true));
  row.pulling_median = meanOf(overRuns(pulling, false));
  row.pulling_wall = meanOf(overRuns(wall, true));
  return row;
}

double realTimeFactor(const Model& model, const std::vector<ScenarioRun>& runs) {
  double wall = 0, simulated = 0;
  for (const ScenarioRun& run : runs)
    for (const SewnSet& set : run.sets)
      for (const StepCosts* costs : {&set.pulling, &set.after}) {
        wall += 1e-3 * std::accumulate(costs->wall.begin(), costs->wall.end(), 0.0);
        simulated += model.scene.step_period * static_cast<double>(costs->wall.size());
      }
  return simulated / wall;
}

}  // namespace

StepTimes timesOf(std::vector<double> costs) {
  StepTimes times;
  if (costs.empty()) return times;
  times.mean = meanOf(costs);
  std::sort(costs.begin(), costs.end());
  const auto at = [&](double part) {
    return costs[static_cast<std::size_t>(std::ceil(part * static_cast<double>(costs.size()))) - 1];
  };
  times.p50 = at(0.5);
  times.p99 = at(0.99);
  times.max = costs.back();
  return times;
}

Slope slopeOf(const std::vector<double>& y) {
  const double n = static_cast<double>(y.size()), middle = (n - 1) / 2, mean = meanOf(y);
  double sxx = 0, sxy = 0, rest = 0;
  for (std::size_t k = 0; k < y.size(); ++k) {
    const double x = static_cast<double>(k) - middle;
    sxx += x * x;
    sxy += x * (y[k] - mean);
  }
  Slope slope;
  if (y.size() < 2) return slope;
  slope.per_step = sxy / sxx;
  for (std::size_t k = 0; k < y.size(); ++k)
    rest += std::pow(y[k] - mean - slope.per_step * (static_cast<double>(k) - middle), 2);
  if (y.size() > 2) slope.error = std::sqrt(rest / (n - 2) / sxx);
  return slope;
}

ScenarioResult runScenario(const std::shared_ptr<const Model>& model, const SetLayout& layout, const std::string& name,
                           int repeats, std::ostream& log) {
  ScenarioResult result;
  result.name = name;
  result.layout = layout;
  std::vector<ScenarioRun> runs;
  for (int r = 0; r < repeats; ++r) {
    log << name << ": run " << r + 1 << " of " << repeats << std::endl;
    runs.push_back(runOnce(model, layout, log));
    if (runs.back().state_hash != runs.front().state_hash)
      throw Error("Two runs of the scenario '" + name + "' ended with different bits; determinism is broken.");
  }
  for (std::size_t set = 0; set < runs.front().sets.size(); ++set) result.rows.push_back(rowOf(runs, set));
  result.state_hash = runs.front().state_hash;
  result.crossed = runs.front().crossed;
  result.real_time_factor = realTimeFactor(*model, runs);
  return result;
}

std::string processorName() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.compare(0, 10, "model name") == 0 && line.find(':') != std::string::npos)
      return line.substr(line.find(':') + 2);
  return "unknown processor";
}

}  // namespace vibe::benchmarks
