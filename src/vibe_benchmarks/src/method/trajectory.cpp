#include "method/trajectory.hpp"

#include <cmath>

#include "vibe_core/files/fnv1a.hpp"
#include "vibe_core/tissue/shell.hpp"

namespace vibe::benchmarks {
namespace {

constexpr int kFirstForceFrame =
    5;  // earlier, the force is that of a shock wave, which steps of one frame cannot resolve

StepSettings settingsOf(const StepChoice& choice) {
  StepSettings settings;
  settings.step = kFrame / choice.steps_per_frame;
  settings.iterations = choice.iterations;
  settings.spectral_radius = choice.spectral_radius;
  settings.backward_euler = choice.backward_euler;
  settings.tolerance = choice.tolerance;
  return settings;
}

/// Kinetic and elastic energy minus the work of the pressure since rest [J].
double totalEnergy(const BenchWall& wall, const BodyMotion& motion) {
  const std::size_t n = wall.body.rest.size();
  std::vector<double> displacement(3 * n), gradient(3 * n);
  double energy = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      displacement[3 * i + k] = motion.x[k][i] - wall.body.rest[i][static_cast<Eigen::Index>(k)];
      energy += 0.5 * wall.body.mass[i] * motion.v[k][i] * motion.v[k][i];
    }
  }
  energy += wall.body.elements->evaluate(displacement.data(), gradient.data());
  return energy - wall.pressure * (wall.body.shell->volume(displacement.data(), gradient.data()) - wall.rest_volume);
}

}  // namespace

Trajectory update(const BenchWall& wall, const BodyMotion& start, const Pull& pull, const StepChoice& choice,
                  int frames) {
  const ImplicitStepper stepper(wall.body, settingsOf(choice));
  const auto scratch = stepper.makeWorkspace();
  StepperMemory memory;
  BodyMotion motion = start;
  stepper.refactor(motion.view(), memory);
  Trajectory trajectory;
  trajectory.frames.push_back(motion);
  if (frames == 0) frames = static_cast<int>(std::lround((pull.duration + pull.hold) / kFrame));
  for (int frame = 0; frame < frames && trajectory.finite; ++frame) {
    double force = 0;
    for (int s = 1; s <= choice.steps_per_frame; ++s) {
      const double time = kFrame * (frame + static_cast<double>(s) / choice.steps_per_frame);
      BodyLoads loads = wallLoads(wall, start, pull.at(time));
      const double before = threadMilliseconds();
      const StepOutcome outcome = stepper.step(motion.view(), loads, memory, *scratch);
      trajectory.times.push_back(threadMilliseconds() - before);
      trajectory.fallback += outcome.fallback && !choice.backward_euler ? 1 : 0;
      trajectory.finite = trajectory.finite && outcome.finite;
      force += toolForce(wall, loads) / choice.steps_per_frame;
    }
    trajectory.force.push_back(force);
    trajectory.frames.push_back(motion);
  }
  // a session computes the first factor while it loads
  if (!trajectory.times.empty()) {
    trajectory.first_time = trajectory.times.front();
    trajectory.times.erase(trajectory.times.begin());
  }
  return trajectory;
}

double driftApart(const BodyMotion& a, const BodyMotion& a_start, const BodyMotion& b, const BodyMotion& b_start) {
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t n = 0; n < a.x[k].size(); ++n) {
      const double apart = (a.x[k][n] - a_start.x[k][n]) - (b.x[k][n] - b_start.x[k][n]);
      sum += apart * apart;
    }
  }
  return std::sqrt(sum);
}

void compare(const Trajectory& trajectory, const Trajectory& reference, const BodyMotion& equilibrium, ResultRow& row) {
  const BodyMotion &start = reference.frames.front(), &own_start = trajectory.frames.front();
  const double whole = distanceBetween(equilibrium, start);
  double motion = 0, force = 0, largest_force = 0;
  for (std::size_t f = 1; f < trajectory.frames.size() && f < reference.frames.size(); ++f)
    motion = std::fmax(motion, driftApart(trajectory.frames[f], own_start, reference.frames[f], start));
  for (std::size_t f = 0; f < reference.force.size(); ++f) {
    largest_force = std::fmax(largest_force, std::abs(reference.force[f]));
    if (f >= kFirstForceFrame && f < trajectory.force.size())
      force = std::fmax(force, std::abs(trajectory.force[f] - reference.force[f]));
  }
  const double lost = std::numeric_limits<double>::infinity();
  row.motion_error = trajectory.finite ? motion / whole : lost;
  row.static_error =
      trajectory.finite ? driftApart(trajectory.frames.back(), own_start, equilibrium, start) / whole : lost;
  if (!trajectory.force.empty()) row.force_error = trajectory.finite ? force / largest_force : lost;
  row.state_hash = hashOf(trajectory.frames.back());
}

double energyDrift(const BenchWall& wall, const BodyMotion& start, const BodyMotion& pulled, const StepChoice& choice) {
  BodyMotion motion = pulled;
  BenchWall free = wall;
  free.body.mass_damping = 0;
  const ImplicitStepper stepper(free.body, settingsOf(choice));
  const auto scratch = stepper.makeWorkspace();
  StepperMemory memory;
  stepper.refactor(motion.view(), memory);
  const double before = totalEnergy(free, motion), rest = totalEnergy(free, start);
  for (int s = 0; s < 60 * choice.steps_per_frame; ++s) {
    BodyLoads loads = pressureLoads(free, free.pressure);
    stepper.step(motion.view(), loads, memory, *scratch);
  }
  return (totalEnergy(free, motion) - before) / (before - rest);
}

std::uint64_t hashOf(const BodyMotion& motion) {
  Fnv1a hash;
  for (const auto* part : {&motion.x, &motion.v})
    for (const auto& values : *part) hash.add(values.data(), values.size() * sizeof(double));
  return hash.result();
}

}  // namespace vibe::benchmarks
