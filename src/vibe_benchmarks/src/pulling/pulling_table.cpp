#include "pulling/pulling_table.hpp"

#include <cstdio>
#include <fstream>

#include "fem/case_runner.hpp"
#include "pulling/pulled_plate.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/solver/implicit_stepper.hpp"

namespace vibe::benchmarks {
namespace {

constexpr int kAll = 1000;
constexpr double kFrame = 1.0 / 60, kSpeed = 15e-3;  // of the cinch [s], [m/s]
constexpr int kRest = 60;                            // frames of rest before a level is measured
constexpr int kMaxFrames = 600;                      // of drawing, before a method counts as ended
constexpr double kLimit = 0.5, kWideLimit = 2;       // of strain
constexpr PullWay kWays[] = {{"shell", "thread", 5, kLimit},
                             {"shell", "groups", 5, kLimit},
                             {"shell", "groups", kAll, kLimit},
                             {"shell", "groups", kAll, kWideLimit},
                             {"shape_matching", "thread", 5, kLimit},
                             {"shape_matching", "groups", 5, kLimit},
                             {"shape_matching", "groups", kAll, kLimit},
                             {"shape_matching", "groups", kAll, kWideLimit}};

std::string nameOf(const PullWay& way) {
  if (std::string(way.pulling) == "thread") return "thread";
  if (way.particles != kAll) return "groups, first 5";
  return way.strain_limit == kLimit ? "groups, all" : "groups, all, limit 2";
}

/// Data shared by the methods: the case, its probe, the rows, and the file of the mid-lines.
struct Table {
  FemCase bench_case = readCase(resolveAddress("package://vibe_benchmarks/cases/case7_cinch.yaml"));
  CaseModel plate{bench_case, Hold::AsFixed};
  CaseProbe probe{plate};
  std::size_t tension = 0, field = 1;
  std::vector<ResultRow> rows;
  std::ofstream profile;

  double distanceAt(double level) const {
    const double rest = 2 * plate.benchCase().spots.at(bench_case.cinch->first).centre.norm();
    return rest + level * (bench_case.cinch->distance - rest);
  }

  void add(const std::string& method, const std::string& setting, std::size_t number, const MotionView& motion,
           double force, const std::vector<double>& times) {
    const double level = bench_case.statics->levels[number];
    ResultRow row;
    char name[40];
    std::snprintf(name, sizeof name, "bites_%.0f_mm", 1e3 * distanceAt(level));
    row.bench_case = name, row.method = method, row.setting = setting;
    row.particles = plate.nodeCount();
    setTimes(times, row);
    const double wanted = *bench_case.samples[tension].reference[number];
    row.motion_error = probe.measure(field, motion, plate.body(0), plate.loads(level), level);
    row.force_error = std::abs(force - wanted) / wanted;
    rows.push_back(row);
  }

  void addProfile(const std::string& method, const std::string& setting, const MotionView& motion, double force) {
    if (!profile.is_open()) return;
    for (int n = 0; n < plate.nodeCount(); ++n)
      if (std::abs(plate.mesh().nodes[n].y()) < 1e-9)
        profile << method << ",\"" << setting << "\"," << motion.x[0][n] << ',' << motion.x[2][n] << ',' << force
                << '\n';
  }
};

void runWay(const PullWay& way, Table& table, std::ostream& log) {
  PulledPlate plate(table.plate, way);
  std::vector<double> times;
  std::size_t level = 0;
  const auto& levels = table.bench_case.statics->levels;
  for (int frame = 0; frame < kMaxFrames && level < levels.size(); ++frame) {
    if (plate.apart() > table.distanceAt(levels[level])) {
      if (!plate.draw()) break;  // the smallest distance that this method reaches
      times.push_back(plate.milliseconds());
      continue;
    }
    for (int k = 0; k < kRest; ++k) plate.step(), times.push_back(plate.milliseconds());
    table.add(way.method, nameOf(way), level, plate.motion(), plate.tension(), times);
    ++level;
  }
  for (int k = 0; level < levels.size() && k < kRest; ++k) plate.step(), times.push_back(plate.milliseconds());
  ResultRow end;
  char name[40];
  std::snprintf(name, sizeof name, "end_%.1f_mm_%.2f_N", 1e3 * plate.apart(), plate.tension());
  end.bench_case = name, end.method = way.method, end.setting = nameOf(way);
  end.particles = table.plate.nodeCount();
  setTimes(times, end);
  table.rows.push_back(end);
  log << "  " << way.method << ", " << nameOf(way) << ": bites end " << 1e3 * plate.apart() << " mm apart at "
      << plate.tension() << " N, frames take " << end.ms_p50 << " ms\n";
  table.addProfile(way.method, nameOf(way), plate.motion(), plate.tension());
}

/// The condition of the case itself, moved at the speed of the cinch in the steps of the shell.
void runConstraint(Table& table, std::ostream& log) {
  StepSettings settings;
  settings.iterations = TissueScene{}.iterations;
  ElasticBody body = table.plate.body(0);
  body.mass_damping = TissueScene{}.mass_damping;
  body.stiffness_damping = TissueScene{}.stiffness_damping;
  const ImplicitStepper stepper(body, settings);
  const auto scratch = stepper.makeWorkspace();
  BodyMotion motion(body);
  StepperMemory memory;
  std::vector<double> times;
  double now = 0, force = 0;
  const double part = kSpeed * kFrame / (table.distanceAt(0) - table.distanceAt(1));
  const auto step = [&](double level) {
    BodyLoads loads = table.plate.loads(level);
    const double before = threadMilliseconds();
    stepper.step(motion.view(), loads, memory, *scratch);
    times.push_back(threadMilliseconds() - before);
    force = -loads.constraints[0].force;
  };
  const auto& levels = table.bench_case.statics->levels;
  for (std::size_t level = 0; level < levels.size(); ++level) {
    while (now < levels[level]) step(now = std::min(levels[level], now + part));
    for (int k = 0; k < kRest; ++k) step(now);
    table.add("shell", "condition", level, motion.view(), force, times);
  }
  log << "  shell, condition: " << force << " N, frames take " << table.rows.back().ms_p50 << " ms\n";
  table.addProfile("shell", "condition", motion.view(), force);
}

}  // namespace

std::vector<ResultRow> runPulling(const std::string& profile, std::ostream& log) {
  Table table;
  if (!profile.empty()) {
    table.profile.open(profile);
    table.profile << "method,setting,x,z,tension\n";
  }
  log << "pulling two bites together, " << table.plate.nodeCount() << " particles\n";
  runConstraint(table, log);
  for (const PullWay& way : kWays) runWay(way, table, log);
  table.profile.close();
  if (!profile.empty() && !table.profile)
    throw Error(profile + ": cannot be written; give --profile a path in a writable folder.");
  return table.rows;
}

}  // namespace vibe::benchmarks
