#include "method/method_table.hpp"

#include <cmath>
#include <sstream>

#include "method/trajectory.hpp"
#include "method/wall.hpp"

namespace vibe::benchmarks {
namespace {

constexpr int kParticles = 3618;  // as in the stomach of the paper
constexpr double kExact = 1e-8;   // [m]
constexpr int kRunRepeats = 5;    // of each timed run; the fastest counts

// two, three and four iterations first: the goals refer to these
constexpr StepChoice kChoices[] = {
    {"60 Hz, 2 iterations", 1, 2, 0.5, false, 1e-7},
    {"60 Hz, 3 iterations", 1, 3, 0.5, false, 1e-7},
    {"60 Hz, 4 iterations", 1, 4, 0.5, false, 1e-7},
    {"60 Hz, 1 iteration", 1, 1, 0.5, false, 1e-7},
    {"60 Hz, 8 iterations", 1, 8, 0.5, false, 1e-7},
    {"60 Hz, 3 iterations, radius 0.2", 1, 3, 0.2, false, 1e-7},
    {"60 Hz, 3 iterations, radius 0.8", 1, 3, 0.8, false, 1e-7},
    {"60 Hz Euler, 3 iterations", 1, 3, 0, true, 1e-7},
    {"120 Hz, 1 iteration", 2, 1, 0.5, false, 1e-7},
    {"240 Hz, 1 iteration", 4, 1, 0.5, false, 1e-7},
    {"1020 Hz, 1 iteration", 17, 1, 0.5, false, 1e-7},
};
constexpr StepChoice kTwo = kChoices[0], kThree = kChoices[1];
constexpr StepChoice kReference{"reference", 16, 4, 0.5, false, 1e-8};
constexpr StepChoice kFinerReference{"reference", 64, 6, 0.5, false, 1e-8};
constexpr double kLetGo = 0.005;  // [m]

/// The settings to which the goals refer.
bool inQuick(const StepChoice& choice) {
  return choice.steps_per_frame == 17 || (choice.steps_per_frame == 1 && choice.iterations <= 4);
}

ResultRow rowOf(const std::string& bench_case, const std::string& method, const std::string& setting, int particles) {
  ResultRow row;
  row.bench_case = bench_case;
  row.method = method;
  row.setting = setting;
  row.particles = particles;
  return row;
}

std::string pullName(double distance, bool jerk) {
  std::ostringstream name;
  name << "pull_" << std::lround(distance * 1000) << "mm" << (jerk ? "_one_frame" : "");
  return name.str();
}

/// The reference for every method.
struct Truth {
  Pull pull;
  BodyMotion start, equilibrium, let_go;
  Trajectory motion;
};

Truth findTruth(const BenchWall& wall, const BodyMotion& start, bool quick, std::ostream& log) {
  const Pull pull;
  double force = 0;
  log << "wall: pulled equilibrium\n";
  const BodyMotion let_go = pulledEquilibrium(wall, start, kLetGo, kExact, force);
  const BodyMotion equilibrium = pulledEquilibrium(wall, start, pull.distance, kExact, force);
  log << "wall: force " << force << " N at 20 mm; time-converged motion\n";
  Truth truth{pull, start, equilibrium, let_go, update(wall, start, pull, quick ? kReference : kFinerReference)};
  if (!quick) {
    ResultRow row;
    compare(update(wall, start, pull, kReference), truth.motion, equilibrium, row);
    log << "wall: a reference with steps four times as long is off by " << 100 * row.motion_error << " %\n";
  }
  return truth;
}

void addPull(const Trajectory& trajectory, const Truth& truth, const std::string& method, const std::string& setting,
             std::vector<ResultRow>& rows) {
  rows.push_back(rowOf(pullName(truth.pull.distance, false), method, setting, kParticles));
  setTimes(trajectory.times, rows.back());
  compare(trajectory, truth.motion, truth.equilibrium, rows.back());
}

/// Repeats the run and keeps the smaller times: other load on the machine only makes it slower.
void keepQuicker(const Trajectory& again, Trajectory& trajectory) {
  if (timesOf(again.times).p50 < timesOf(trajectory.times).p50) trajectory.times = again.times;
}

/// The pull of 20 mm in 0.5 s with every setting of the shell in its default configuration.
void addSettings(const BenchWall& wall, const Truth& truth, bool quick, std::ostream& log,
                 std::vector<ResultRow>& rows) {
  for (const StepChoice& choice : kChoices) {
    if (quick && !inQuick(choice)) continue;
    log << "wall: " << choice.name << "\n";
    Trajectory trajectory = update(wall, truth.start, truth.pull, choice);
    for (int again = 1; again < (quick ? 1 : kRunRepeats); ++again)
      keepQuicker(update(wall, truth.start, truth.pull, choice), trajectory);
    addPull(trajectory, truth, "implicit", choice.name, rows);
    rows.back().energy_drift = energyDrift(wall, truth.start, truth.let_go, choice);
    if (trajectory.fallback > 0) log << "wall:   " << trajectory.fallback << " steps with backward Euler\n";
  }
}

/// The same pull with the other tissue model on the same mesh.
void addShapeMatching(const BenchWall& wall, const Truth& truth, std::ostream& log, std::vector<ResultRow>& rows) {
  log << "wall: shape matching\n";
  int substeps = 0;
  const Trajectory matched = runShapeMatching(wall, truth.pull, substeps);
  addPull(matched, truth, "shape_matching", "60 Hz, " + std::to_string(substeps) + " sub-steps", rows);
}

/// One long pull with one setting, to check the equilibrium 1.5 s after the stop.
void addLongPull(const BenchWall& wall, const BodyMotion& start, const BodyMotion& equilibrium, double force,
                 const Pull& pull, const StepChoice& choice, std::ostream& log, std::vector<ResultRow>& rows) {
  const std::string name = pullName(pull.distance, pull.duration == kFrame);
  log << "wall: " << name << ", " << choice.name << "\n";
  const Trajectory trajectory = update(wall, start, pull, choice);
  rows.push_back(rowOf(name, "implicit", choice.name, kParticles));
  setTimes(trajectory.times, rows.back());
  rows.back().static_error =
      distanceBetween(trajectory.frames.back(), equilibrium) / distanceBetween(start, equilibrium);
  rows.back().force_error = std::abs(trajectory.force.back() - force) / std::abs(force);
  rows.back().state_hash = hashOf(trajectory.frames.back());
  if (trajectory.fallback > 0) log << "wall:   " << trajectory.fallback << " steps with backward Euler\n";
}

void addLongPulls(const BenchWall& wall, const BodyMotion& start, bool quick, std::ostream& log,
                  std::vector<ResultRow>& rows) {
  for (const double distance : {0.03, 0.04, 0.05}) {
    if (quick && distance < 0.045) continue;
    double force = 0;
    const BodyMotion equilibrium = pulledEquilibrium(wall, start, distance, kExact, force);
    for (const double duration : {0.5, kFrame})
      for (const StepChoice& choice : {kTwo, kThree})
        addLongPull(wall, start, equilibrium, force, Pull{distance, duration, 1.5}, choice, log, rows);
  }
}

/// The first third of a second of the pull on increasingly fine meshes, and the cost of their first factor.
void addGrowth(bool quick, std::ostream& log, std::vector<ResultRow>& rows) {
  for (const int particles : {1000, 3618, 15000, 60000}) {
    if (quick && particles > 4000) continue;
    log << "growth: " << particles << " particles\n";
    const BenchWall wall = makeWall(particles);
    const BodyMotion start = inflate(wall, 1e-6);
    Trajectory trajectory = update(wall, start, Pull{}, kThree, 20);
    for (int again = 1; again < (quick || particles > 20000 ? 1 : kRunRepeats); ++again)
      keepQuicker(update(wall, start, Pull{}, kThree, 20), trajectory);
    rows.push_back(rowOf("growth", "implicit", kThree.name, particles));
    setTimes(trajectory.times, rows.back());
    log << "growth: " << 1e3 * rows.back().ms_p50 / particles << " us per particle and step, " << trajectory.first_time
        << " ms with the factor\n";
    rows.back().state_hash = hashOf(trajectory.frames.back());
    const double factor = trajectory.first_time - rows.back().ms_p50;
    rows.push_back(rowOf("growth_factor", "implicit", "stiffness and factor", particles));
    setTimes({factor}, rows.back());
  }
}

}  // namespace

std::vector<ResultRow> runMethods(bool quick, std::ostream& log) {
  std::vector<ResultRow> rows;
  const BenchWall wall = makeWall(kParticles);
  log << "wall: " << kParticles << " particles, " << wall.tool.size() << " of them held by the disc; inflation\n";
  const BodyMotion start = inflate(wall, kExact);
  const Truth truth = findTruth(wall, start, quick, log);
  addSettings(wall, truth, quick, log, rows);
  addShapeMatching(wall, truth, log, rows);
  addLongPulls(wall, start, quick, log, rows);
  addGrowth(quick, log, rows);
  return rows;
}

}  // namespace vibe::benchmarks
