#include "suture/set_scenario.hpp"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "output/result_row.hpp"
#include "suture/suture_session.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/suture/technique.hpp"

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

namespace {

std::string eventsOf(const SewnSet& set) {
  std::string text;
  const auto add = [&](int count, const char* name) {
    if (count > 0) text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + name;
  };
  add(set.tear_outs, "torn out");
  add(set.breaks, "broken");
  add(set.recoveries, "recoveries");
  add(set.refusals, "refused");
  add(set.loose, "loose");
  return text.empty() ? "-" : text;
}

const char* techniqueOf(const SewnSet& set) {
  return toString(static_cast<Technique>(set.technique));
}

void printSlope(const char* what, const std::vector<double>& means, std::ostream& out) {
  const Slope slope = slopeOf(means);
  printTo(out, "  %s: %+.3f +- %.3f ms per set\n", what, slope.per_step, slope.error);
}

}  // namespace

void printScenario(const ScenarioResult& result, std::ostream& out) {
  char line[320];
  std::snprintf(line, sizeof line, "%s: CPU ms per step, prototype %.1f ms\n", result.name.c_str(), result.reference);
  out << line << "set technique steps | pulling mean  p50    p99    max  median | after mean  p50    p99    max |"
      << " tension drawn  volume balance | events\n";
  std::vector<double> pulling, after;
  for (std::size_t k = 0; k < result.rows.size(); ++k) {
    const ScenarioRow& row = result.rows[k];
    const SewnSet& set = row.set;
    printTo(out,
            "%3zu %-9s %5zu | %12.2f %6.2f %6.2f %6.2f %6.2f | %10.2f %6.2f %6.2f %6.2f | %5.2f N %3.0f mm %5.0f mL "
            "%.4f J | %s, %d careful\n",
            k + 1, techniqueOf(set), set.pulling.cpu.size(), row.pulling.mean, row.pulling.p50, row.pulling.p99,
            row.pulling.max, row.pulling_median, row.after.mean, row.after.p50, row.after.p99, row.after.max,
            set.tension, 1e3 * set.drawn, 1e6 * set.volume, set.balance, eventsOf(set).c_str(), set.fallback_steps);
    pulling.push_back(row.pulling.mean);
    after.push_back(row.after.mean);
  }
  printSlope("slope of pulling", pulling, out);
  printSlope("slope after it", after, out);
  printTo(out, "  %.1f times real time, walls %s, hash %016" PRIx64 "\n", result.real_time_factor,
          result.crossed ? "CROSS one another" : "do not cross", result.state_hash);
}

void writeScenarios(const std::vector<ScenarioResult>& results, std::ostream& out) {
  out << "scenario,set,bites,technique,steps,pulling_mean,pulling_p50,pulling_p99,pulling_max,pulling_median,"
         "pulling_wall,after_mean,after_p50,after_p99,after_max,prototype,tension,drawn,volume,balance,torn_out,broken,"
         "recoveries,refused,loose,careful,state_hash\n";
  for (const ScenarioResult& result : results)
    for (std::size_t k = 0; k < result.rows.size(); ++k) {
      const ScenarioRow& row = result.rows[k];
      const SewnSet& set = row.set;
      printTo(out,
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
