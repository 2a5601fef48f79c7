#include <algorithm>
#include <cmath>

#include "fem/case_runner.hpp"
#include "fem/static_path.hpp"
#include "fem/vibration.hpp"
#include "vibe_core/files/fnv1a.hpp"

namespace vibe::benchmarks {
namespace {

double levelAt(const TransientRun& run, double time) {
  if (run.path.empty()) return 0;
  if (time <= run.path.front()[0]) return run.path.front()[1];
  for (std::size_t i = 1; i < run.path.size(); ++i) {
    const auto &a = run.path[i - 1], &b = run.path[i];
    if (time < b[0]) return a[1] + (b[1] - a[1]) * (time - a[0]) / (b[0] - a[0]);
  }
  return run.path.back()[1];
}

void placeStart(const FemCase& bench_case, const CaseModel& model, MotionView motion) {
  const TransientRun& run = *bench_case.transient;
  if (run.start_at_equilibrium) {
    StaticPath path(model, 1e-9);
    path.advanceTo(run.start_level, 10);
    for (int k = 0; k < 3; ++k) std::copy_n(path.motion().x[k], model.nodeCount(), motion.x[k]);
  }
  if (run.start_mode > 0) {
    const Modes modes = slowestModes(model.body(0), run.start_mode);
    for (int n = 0; n < model.nodeCount(); ++n)
      for (int k = 0; k < 3; ++k) motion.x[k][n] += run.start_amplitude * modes.shape(3 * n + k, run.start_mode - 1);
  }
}

/// Difference from a table of (time, value) up to a given time: sqrt(sum d^2 / sum ref^2).
double seriesDifference(const Sample& sample, const std::vector<double>& values, double step) {
  const NumberTable table = readTable(sample.table);
  const int column = table.column(sample.column);
  double difference = 0, size = 0;
  for (const auto& row : table.rows) {
    const double at = row[0] / step;
    const auto before = static_cast<std::size_t>(std::max(0.0, std::floor(at + 1e-9)));
    if ((sample.until > 0 && row[0] > sample.until + 1e-12) || before >= values.size()) break;
    const std::size_t after = std::min(before + 1, values.size() - 1);
    const double value = values[before] + (at - static_cast<double>(before)) * (values[after] - values[before]);
    difference += (value - row[column]) * (value - row[column]);
    size += row[column] * row[column];
  }
  return std::sqrt(difference / size);
}

/// Results of one transient run.
struct Record {
  std::vector<std::vector<double>> values;  // per sample, per step, the start first
  std::vector<double> times;                // [ms]
  double energy_drift = kNotApplicable;
  std::uint64_t state_hash = 0;
  int unfinished = 0;  // steps that were not finite
};

double kineticEnergy(const ElasticBody& body, const MotionView& motion) {
  double energy = 0;
  for (int n = 0; n < body.nodeCount(); ++n)
    for (int k = 0; k < 3; ++k) energy += 0.5 * body.mass[n] * motion.v[k][n] * motion.v[k][n];
  return energy;
}

double energyOf(const ElasticBody& body, const MotionView& motion) {
  const std::size_t n = body.rest.size();
  std::vector<double> displacement(3 * n), gradient(3 * n);
  for (std::size_t i = 0; i < n; ++i)
    for (int k = 0; k < 3; ++k) displacement[3 * i + k] = motion.x[k][i] - body.rest[i][k];
  return body.elements->evaluate(displacement.data(), gradient.data()) + kineticEnergy(body, motion);
}

Record update(const FemCase& bench_case, const CaseModel& model) {
  const TransientRun& run = *bench_case.transient;
  const CaseProbe probe(model);
  StepSettings settings;
  settings.step = run.step;
  settings.spectral_radius = run.spectral_radius;
  settings.backward_euler = run.backward_euler;
  settings.iterations = run.iterations;
  settings.tolerance = run.tolerance;
  settings.refactor_interval = run.refactor_interval;
  // dead loads are constant during a transient run: use those at the end of the path; the start state is set before
  const double end_level = levelAt(run, run.duration);
  const ImplicitStepper stepper(model.body(end_level), settings);
  const auto scratch = stepper.makeWorkspace();
  StepperMemory memory;
  BodyMotion motion(stepper.body());
  placeStart(bench_case, model, motion.view());
  stepper.refactor(motion.view(), memory);
  Record record;
  record.values.resize(bench_case.samples.size());
  const bool released = run.path.empty();
  const double energy = released ? energyOf(stepper.body(), motion.view()) : 0;
  const int steps = static_cast<int>(std::lround(run.duration / run.step));
  BodyLoads loads = model.loads(levelAt(run, 0));
  for (int i = 0; i <= steps; ++i) {
    if (i > 0) {
      loads = model.loads(levelAt(run, i * run.step));
      const double start = threadMilliseconds();
      const StepOutcome outcome = stepper.step(motion.view(), loads, memory, *scratch);
      record.times.push_back(threadMilliseconds() - start);
      record.unfinished += outcome.finite ? 0 : 1;
    }
    for (std::size_t s = 0; s < bench_case.samples.size(); ++s) {
      // tables are compared only at the end
      const bool wait = bench_case.samples[s].kind == SampleKind::StaticField && i < steps;
      if (!wait) record.values[s].push_back(probe.measure(s, motion.view(), stepper.body(), loads, end_level));
    }
  }
  if (released) record.energy_drift = energyOf(stepper.body(), motion.view()) / energy - 1;
  Fnv1a hash;
  for (const auto* part : {&motion.x, &motion.v})
    for (const auto& values : *part) hash.add(values.data(), values.size() * sizeof(double));
  record.state_hash = hash.result();
  return record;
}

double reduce(const Sample& sample, const std::vector<double>& values, double step) {
  if (sample.kind == SampleKind::Frequency) return measureOscillation(values, step).frequency;
  if (sample.kind == SampleKind::Kept) return measureOscillation(values, step).kept;
  if (sample.kind == SampleKind::Series) return seriesDifference(sample, values, step);
  return values.back();
}

}  // namespace

std::vector<ResultRow> runTransient(const FemCase& bench_case, std::ostream& log, std::vector<CaseValue>& values) {
  const CaseModel model(bench_case, Hold::AsConditions);
  const Record record = update(bench_case, model);
  if (record.unfinished > 0) log << "  NOT FINITE in " << record.unfinished << " steps\n";
  std::vector<ResultRow> rows;
  for (std::size_t s = 0; s < bench_case.samples.size(); ++s) {
    const Sample& sample = bench_case.samples[s];
    const double value = reduce(sample, record.values[s], bench_case.transient->step);
    printSample(sample, 0, "", value, log);
    const std::size_t steps = record.times.size(), after = steps + 1 - record.values[s].size();
    for (std::size_t i = 1; i <= steps; ++i)
      if (i >= after)
        values.push_back({bench_case.name, sample.name, double(i) * bench_case.transient->step,
                          record.values[s][i - after], record.times[i - 1]});
    rows.push_back(caseRow(bench_case, sample.name, model.nodeCount()));
    // a session computes the first factor while it loads
    setTimes({record.times.begin() + (record.times.size() > 1 ? 1 : 0), record.times.end()}, rows.back());
    rows.back().reference_error = referenceError(sample, 0, value);
    rows.back().energy_drift = record.energy_drift;
    rows.back().state_hash = record.state_hash;
  }
  return rows;
}

}  // namespace vibe::benchmarks
