#include "method/method_table.hpp"

#include <cmath>
#include <cstdio>
#include <sstream>

#include "method/bullet_wall.hpp"
#include "method/trajectory.hpp"
#include "method/wall.hpp"

namespace vibe {
namespace {

constexpr int kParticles = 3618;  // of the paper's stomach
constexpr double kExact = 1e-8;   // [m]

constexpr StepChoice kChoices[] = {
    {"60 Hz, 1 iteration", 1, 1, 0.8, false, 1e-7},   {"60 Hz, 2 iterations", 1, 2, 0.8, false, 1e-7},
    {"60 Hz, 3 iterations", 1, 3, 0.8, false, 1e-7},  {"60 Hz, 4 iterations", 1, 4, 0.8, false, 1e-7},
    {"60 Hz, 8 iterations", 1, 8, 0.8, false, 1e-7},  {"60 Hz Euler, converged", 1, 12, 0.8, true, 1e-7},
    {"120 Hz, 2 iterations", 2, 2, 0.8, false, 1e-7}, {"120 Hz, 4 iterations", 2, 4, 0.8, false, 1e-7},
    {"240 Hz, 2 iterations", 4, 2, 0.8, false, 1e-7}, {"1020 Hz, 1 iteration", 17, 1, 0.8, false, 1e-7},
};
constexpr StepChoice kReference{"reference", 16, 4, 0.8, false, 1e-8};
constexpr StepChoice kFinerReference{"reference", 64, 6, 0.8, false, 1e-8};
constexpr double kLetGo = 0.005;  // [m]
constexpr StepChoice kDefault = kChoices[2];

/// The settings on either side of the goals: one to four iterations of a frame, and the millisecond.
bool inQuick(const StepChoice& choice) {
  return choice.backward_euler || choice.steps_per_frame == 17 ||
         (choice.steps_per_frame == 1 && choice.iterations <= 4);
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

/// The pull of 20 mm in 0.5 s with every setting.
void addSettings(const Wall& wall, const BodyMotion& start, bool quick, std::ostream& log,
                 std::vector<ResultRow>& rows) {
  const Pull pull;
  double force = 0;
  log << "wall: pulled equilibrium\n";
  const BodyMotion equilibrium = pulledEquilibrium(wall, start, pull.distance, kExact, force);
  log << "wall: force " << force << " N at 20 mm; time-converged motion\n";
  const Trajectory reference = follow(wall, start, pull, quick ? kReference : kFinerReference);
  const BodyMotion let_go = pulledEquilibrium(wall, start, kLetGo, kExact, force);
  if (!quick) {
    ResultRow row = rowOf(pullName(pull.distance, false), "implicit", "960 Hz, converged", kParticles);
    compare(follow(wall, start, pull, kReference), reference, equilibrium, row);
    log << "wall: a reference with steps four times as long is off by " << 100 * row.motion_error << " %\n";
  }
  for (const StepChoice& choice : kChoices) {
    if (quick && !inQuick(choice)) continue;
    log << "wall: " << choice.name << "\n";
    const Trajectory trajectory = follow(wall, start, pull, choice);
    rows.push_back(rowOf(pullName(pull.distance, false), "implicit", choice.name, kParticles));
    setTimes(trajectory.times, rows.back());
    compare(trajectory, reference, equilibrium, rows.back());
    rows.back().energy_drift = energyDrift(wall, start, let_go, choice);
    if (trajectory.careful > 0) log << "wall:   " << trajectory.careful << " careful steps\n";
  }
  for (const auto& [steps, iterations] : {std::pair<int, int>{1, 20}, {8, 4}, {32, 4}}) {
    if (quick && steps > 1) continue;
    char setting[40];
    std::snprintf(setting, sizeof setting, "%d Hz, %d iterations", 60 * steps, iterations);
    log << "wall: Bullet, " << setting << "\n";
    const Trajectory trajectory = followBullet(wall, pull, steps, iterations);
    rows.push_back(rowOf(pullName(pull.distance, false), "bullet_softbody", setting, kParticles));
    setTimes(trajectory.times, rows.back());
    compare(trajectory, reference, equilibrium, rows.back());
  }
}

/// Long pulls, slow and in one frame: is the equilibrium the right one 1.5 s after the stop?
void addLongPulls(const Wall& wall, const BodyMotion& start, bool quick, std::ostream& log,
                  std::vector<ResultRow>& rows) {
  for (const double distance : {0.03, 0.04, 0.05}) {
    if (quick && distance < 0.045) continue;
    double force = 0;
    const BodyMotion equilibrium = pulledEquilibrium(wall, start, distance, kExact, force);
    for (const bool jerk : {false, true}) {
      const Pull pull{distance, jerk ? kFrame : 0.5, 1.5};
      const std::string name = pullName(distance, jerk);
      log << "wall: " << name << "\n";
      const Trajectory trajectory = follow(wall, start, pull, kDefault);
      rows.push_back(rowOf(name, "implicit", kDefault.name, kParticles));
      setTimes(trajectory.times, rows.back());
      rows.back().static_error =
          distanceBetween(trajectory.frames.back(), equilibrium) / distanceBetween(start, equilibrium);
      rows.back().force_error = std::abs(trajectory.force.back() - force) / std::abs(force);
      rows.back().state_hash = hashOf(trajectory.frames.back());
      if (trajectory.careful > 0) log << "wall:   " << trajectory.careful << " careful steps\n";
    }
  }
}

/// The first third of a second of the pull on finer and finer meshes.
void addGrowth(bool quick, std::ostream& log, std::vector<ResultRow>& rows) {
  for (const int particles : {1000, 3618, 15000, 60000}) {
    if (quick && particles > 4000) continue;
    log << "growth: " << particles << " particles\n";
    const Wall wall = makeWall(particles);
    const BodyMotion start = inflate(wall, 1e-6);
    const Trajectory trajectory = follow(wall, start, Pull{}, kDefault, 20);
    rows.push_back(rowOf("growth", "implicit", kDefault.name, particles));
    setTimes(trajectory.times, rows.back());
    rows.back().state_hash = hashOf(trajectory.frames.back());
  }
}

}  // namespace

std::vector<ResultRow> runMethods(bool quick, std::ostream& log) {
  std::vector<ResultRow> rows;
  const Wall wall = makeWall(kParticles);
  log << "wall: " << kParticles << " particles, " << wall.tool.size() << " of them held by the disc; inflation\n";
  const BodyMotion start = inflate(wall, kExact);
  addSettings(wall, start, quick, log, rows);
  addLongPulls(wall, start, quick, log, rows);
  addGrowth(quick, log, rows);
  return rows;
}

}  // namespace vibe
