#include "fem/case_runner.hpp"

#include <algorithm>

#include "fem/case_model.hpp"
#include "fem/case_symmetry.hpp"
#include "fem/static_path.hpp"
#include "fem/vibration.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::benchmarks {

namespace {

bool isDifference(const Sample& sample) {
  return sample.kind == SampleKind::Profile || sample.kind == SampleKind::StaticField ||
         sample.kind == SampleKind::Series;
}

}  // namespace

ResultRow caseRow(const FemCase& bench_case, const std::string& setting, int particles) {
  ResultRow row;
  row.bench_case = bench_case.name;
  row.method = bench_case.element == ElementKind::Shell       ? "shell"
               : bench_case.element == ElementKind::LinearTet ? "linear_tet"
                                                              : "quadratic_tet";
  row.setting = setting;
  row.particles = particles;
  return row;
}

double referenceError(const Sample& sample, std::size_t level, double value) {
  if (isDifference(sample)) return value;
  if (level >= sample.reference.size() || !sample.reference[level]) return kNotApplicable;
  const double wanted = *sample.reference[level];
  return std::abs(value - wanted) / std::abs(wanted);
}

void printSample(const Sample& sample, std::size_t level, const std::string& at, double value, std::ostream& log) {
  const double error = referenceError(sample, level, value);
  if (isDifference(sample)) {
    log << formatted("  %-28s %-14s difference %.3f %%\n", sample.name.c_str(), at.c_str(), 100 * value);
  } else if (std::isnan(error)) {
    log << formatted("  %-28s %-14s %.6g\n", sample.name.c_str(), at.c_str(), value);
  } else {
    log << formatted("  %-28s %-14s %.6g  reference %.6g  error %.3f %%\n", sample.name.c_str(), at.c_str(), value,
                     *sample.reference[level], 100 * error);
  }
}

std::vector<ResultRow> runModes(const FemCase& bench_case, std::ostream& log, std::vector<CaseValue>& values) {
  const CaseModel model(bench_case, Hold::AsFixed);
  const double start = threadMilliseconds();
  const Modes modes = slowestModes(model.body(0), bench_case.modes->count);
  const double time = threadMilliseconds() - start;
  std::vector<ResultRow> rows;
  for (const Sample& sample : bench_case.samples) {
    if (sample.mode < 1 || sample.mode > bench_case.modes->count)
      throw Error(bench_case.file + ": sample '" + sample.name +
                  "' asks for a mode beyond modes.count; raise the count.");
    const double value = modes.frequency[static_cast<std::size_t>(sample.mode - 1)];
    printSample(sample, 0, "", value, log);
    values.push_back({bench_case.name, sample.name, double(sample.mode), value, time});
    rows.push_back(caseRow(bench_case, sample.name, model.nodeCount()));
    rows.back().reference_error = referenceError(sample, 0, value);
    setTimes({time}, rows.back());
  }
  return rows;
}

std::vector<ResultRow> runCase(const FemCase& bench_case, std::ostream& log, std::vector<CaseValue>& values) {
  log << bench_case.name << " (" << bench_case.file << ")\n";
  if (bench_case.statics) return runStatic(bench_case, log, values);
  if (bench_case.transient) return runTransient(bench_case, log, values);
  return runModes(bench_case, log, values);
}

namespace {

const char* const kPlanes[3] = {"x", "y", "z"};

std::string levelName(double level) {
  return formatted("level %.5g", level);
}

/// The vertex of the parabola through the largest value and its neighbours, for equidistant levels.
double largest(const std::vector<double>& values) {
  const auto top = static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin());
  if (top == 0 || top + 1 >= values.size()) return values[top];
  const double before = values[top - 1] - values[top], after = values[top + 1] - values[top];
  return values[top] - (after - before) * (after - before) / (8 * (after + before));
}

}  // namespace

std::vector<ResultRow> runStatic(const FemCase& bench_case, std::ostream& log, std::vector<CaseValue>& out) {
  const CaseModel model(bench_case, Hold::AsFixed);
  const CaseProbe probe(model);
  StaticPath path(model, bench_case.statics->tolerance);
  const std::size_t count = bench_case.samples.size();
  const CaseSymmetry symmetry(model);
  Branch branch = symmetry.known() ? Branch::Same : Branch::Unknown;
  std::vector<std::vector<double>> values(count);
  std::vector<double> times;
  for (const double level : bench_case.statics->levels) {
    const double start = threadMilliseconds();
    const bool converged = path.advanceTo(level, bench_case.statics->substeps);
    if (!converged) log << "  NOT CONVERGED at " << levelName(level) << "\n";
    times.push_back(threadMilliseconds() - start);
    if (const auto lost = symmetry.lost(path.motion())) {
      branch = Branch::Other;
      log << "  WARNING: ANOTHER BRANCH at " << levelName(level) << ": the equilibrium is no mirror image of itself in "
          << kPlanes[*lost] << ", as it is for small loads; it has buckled, and the reference may not have\n";
    }
    for (std::size_t s = 0; s < count; ++s) {
      values[s].push_back(probe.measure(s, path.motion(), path.body(), path.loads(), level));
      const double value = converged ? values[s].back() : kNotApplicable;
      out.push_back({bench_case.name, bench_case.samples[s].name, level, value, times.back()});
    }
  }
  std::vector<ResultRow> rows;
  for (std::size_t s = 0; s < count; ++s) {
    const Sample& sample = bench_case.samples[s];
    rows.push_back(caseRow(bench_case, sample.name, model.nodeCount()));
    setTimes(times, rows.back());
    rows.back().branch = branch;
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
