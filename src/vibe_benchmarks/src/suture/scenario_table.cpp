#include <cinttypes>
#include <cstdio>

#include "suture/set_scenario.hpp"
#include "vibe_core/suture/technique.hpp"

namespace vibe::benchmarks {
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
  char line[160];
  std::snprintf(line, sizeof line, "  %s: %+.3f +- %.3f ms per set\n", what, slope.per_step, slope.error);
  out << line;
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
    std::snprintf(
        line, sizeof line,
        "%3zu %-9s %5zu | %12.2f %6.2f %6.2f %6.2f %6.2f | %10.2f %6.2f %6.2f %6.2f | %5.2f N %3.0f mm %5.0f mL "
        "%.4f J | %s, %d careful\n",
        k + 1, techniqueOf(set), set.pulling.cpu.size(), row.pulling.mean, row.pulling.p50, row.pulling.p99,
        row.pulling.max, row.pulling_median, row.after.mean, row.after.p50, row.after.p99, row.after.max, set.tension,
        1e3 * set.drawn, 1e6 * set.volume, set.balance, eventsOf(set).c_str(), set.fallback_steps);
    out << line;
    pulling.push_back(row.pulling.mean);
    after.push_back(row.after.mean);
  }
  printSlope("slope of pulling", pulling, out);
  printSlope("slope after it", after, out);
  std::snprintf(line, sizeof line, "  %.1f times real time, walls %s, hash %016" PRIx64 "\n", result.real_time_factor,
                result.crossed ? "CROSS one another" : "do not cross", result.state_hash);
  out << line;
}

void writeScenarios(const std::vector<ScenarioResult>& results, std::ostream& out) {
  out << "scenario,set,bites,technique,steps,pulling_mean,pulling_p50,pulling_p99,pulling_max,pulling_median,"
         "pulling_wall,after_mean,after_p50,after_p99,after_max,prototype,tension,drawn,volume,balance,torn_out,broken,"
         "recoveries,refused,loose,careful,state_hash\n";
  char line[480];
  for (const ScenarioResult& result : results)
    for (std::size_t k = 0; k < result.rows.size(); ++k) {
      const ScenarioRow& row = result.rows[k];
      const SewnSet& set = row.set;
      std::snprintf(
          line, sizeof line,
          "%s,%zu,%d,%s,%zu,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.6g,%.4g,%d,%d,%d,"
          "%d,%d,%d,%016" PRIx64 "\n",
          result.name.c_str(), k + 1, set.bites, techniqueOf(set), set.pulling.cpu.size(), row.pulling.mean,
          row.pulling.p50, row.pulling.p99, row.pulling.max, row.pulling_median, row.pulling_wall, row.after.mean,
          row.after.p50, row.after.p99, row.after.max, result.reference, set.tension, set.drawn, set.volume,
          set.balance, set.tear_outs, set.breaks, set.recoveries, set.refusals, set.loose, set.fallback_steps,
          result.state_hash);
      out << line;
    }
}

}  // namespace vibe::benchmarks
