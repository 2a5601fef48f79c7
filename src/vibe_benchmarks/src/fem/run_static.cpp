#include <algorithm>
#include <cstdio>

#include "fem/case_probe.hpp"
#include "fem/case_runner.hpp"
#include "fem/static_path.hpp"

namespace vibe::benchmarks {
namespace {

std::string levelName(double level) {
  char text[32];
  std::snprintf(text, sizeof text, "level %.5g", level);
  return text;
}

/// The vertex of the parabola through the largest value and its neighbours, for equidistant levels.
double largest(const std::vector<double>& values) {
  const auto top = static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin());
  if (top == 0 || top + 1 >= values.size()) return values[top];
  const double before = values[top - 1] - values[top], after = values[top + 1] - values[top];
  return values[top] - (after - before) * (after - before) / (8 * (after + before));
}

}  // namespace

std::vector<ResultRow> runStatic(const FemCase& bench_case, std::ostream& log) {
  const CaseModel model(bench_case, Hold::AsFixed);
  const CaseProbe probe(model);
  StaticPath path(model, bench_case.statics->tolerance);
  const std::size_t count = bench_case.samples.size();
  std::vector<std::vector<double>> values(count);
  std::vector<double> times;
  for (const double level : bench_case.statics->levels) {
    const double start = threadMilliseconds();
    if (!path.advanceTo(level, bench_case.statics->substeps)) log << "  NOT CONVERGED at " << levelName(level) << "\n";
    times.push_back(threadMilliseconds() - start);
    for (std::size_t s = 0; s < count; ++s)
      values[s].push_back(probe.measure(s, path.motion(), path.body(), path.loads(), level));
  }
  std::vector<ResultRow> rows;
  for (std::size_t s = 0; s < count; ++s) {
    const Sample& sample = bench_case.samples[s];
    rows.push_back(caseRow(bench_case, sample.name, model.nodeCount()));
    setTimes(times, rows.back());
    if (sample.kind == SampleKind::LimitPressure) values[s] = {largest(values[s])};
    for (std::size_t level = 0; level < values[s].size(); ++level) {
      const double error = referenceError(sample, level, values[s][level]);
      if (!std::isnan(error)) rows.back().reference_error = std::fmax(rows.back().reference_error, error);
      const bool one = sample.kind == SampleKind::LimitPressure;
      printSample(sample, level, one ? "" : levelName(bench_case.statics->levels[level]), values[s][level], log);
    }
  }
  return rows;
}

}  // namespace vibe::benchmarks
