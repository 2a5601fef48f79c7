#include "suture/set_scenario.hpp"

#include <algorithm>
#include <cinttypes>
#include <numeric>

#include "output/result_row.hpp"
#include "suture/suture_session.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/suture/technique.hpp"

namespace vibe::benchmarks {

namespace {

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

ScenarioResult runScenario(const std::shared_ptr<const Model>& model, const SetLayout& layout, const std::string& name,
                           int repeats, std::ostream& log) {
  ScenarioResult result;
  result.name = name;
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

namespace {

const char* techniqueOf(const SewnSet& set) {
  return toString(static_cast<Technique>(set.technique));
}

}  // namespace

void writeScenarios(const std::vector<ScenarioResult>& results, std::ostream& out) {
  out << "scenario,set,bites,technique,steps,pulling_mean,pulling_p50,pulling_p99,pulling_max,pulling_median,"
         "pulling_wall,after_mean,after_p50,after_p99,after_max,prototype,tension,drawn,volume,balance,torn_out,broken,"
         "recoveries,refused,loose,careful,state_hash\n";
  for (const ScenarioResult& result : results)
    for (std::size_t k = 0; k < result.rows.size(); ++k) {
      const ScenarioRow& row = result.rows[k];
      const SewnSet& set = row.set;
      out << formatted(
          "%s,%zu,%d,%s,%zu,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.6g,%.4g,%d,%d,%d,"
          "%d,%d,%d,%016" PRIx64 "\n",
          result.name.c_str(), k + 1, set.bites, techniqueOf(set), set.pulling.cpu.size(), row.pulling.mean,
          row.pulling.p50, row.pulling.p99, row.pulling.max, row.pulling_median, row.pulling_wall, row.after.mean,
          row.after.p50, row.after.p99, row.after.max, result.reference, set.tension, set.drawn, set.volume,
          set.balance, set.tear_outs, set.breaks, set.recoveries, set.refusals, set.loose, set.fallback_steps,
          result.state_hash);
    }
}

}  // namespace vibe::benchmarks
