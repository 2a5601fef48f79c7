#pragma once

#include <vector>

#include "method/wall.hpp"
#include "output/result_row.hpp"
#include "vibe_core/solver/implicit_stepper.hpp"

namespace vibe::benchmarks {

constexpr double kFrame = 1.0 / 60;  ///< [s]

/// The wall at the end of each frame, beginning with the initial state.
struct Trajectory {
  std::vector<BodyMotion> frames;
  std::vector<double> force;  ///< of the disc, mean over each frame; force[0] belongs to the first frame [N]
  std::vector<double> times;  ///< thread CPU of each step but the first [ms]
  double first_time = 0;      ///< of the first step, which includes the first factor [ms]
  int fallback = 0;           ///< steps taken with backward Euler, because one of the last did not arrive
  bool finite = true;
};

/// One setting of the implicit stepper.
struct StepChoice {
  const char* name;
  int steps_per_frame;
  int iterations;
  double spectral_radius;
  bool backward_euler;
  double tolerance;  ///< [m]
};

/// @param frames  number of frames to run; 0: the whole pull and hold
Trajectory update(const BenchWall& wall, const BodyMotion& start, const Pull& pull, const StepChoice& choice,
                  int frames = 0);

/// Errors of a trajectory relative to another, for displacements from their own starts: motion_error, force_error
/// (after the fifth frame) and static_error (the last frame against `equilibrium`), divided by the distance from start
/// to `equilibrium`.
void compare(const Trajectory& trajectory, const Trajectory& reference, const BodyMotion& equilibrium, ResultRow& row);

/// Distance between two displacements from their own starts [m].
double driftApart(const BodyMotion& a, const BodyMotion& a_start, const BodyMotion& b, const BodyMotion& b_start);

/// Relative change of the energy over one second after the disc releases `pulled`, without damping.
double energyDrift(const BenchWall& wall, const BodyMotion& start, const BodyMotion& pulled, const StepChoice& choice);

/// FNV-1a of positions and velocities.
std::uint64_t hashOf(const BodyMotion& motion);

/// The same mesh, masses, damping and pull with the simulator's shape matching and its position-based solver, with the
/// number of sub-steps that the stiffness requires; the disc moves 17 times per frame. Young's modulus is that of the
/// wall, but the law is linear in the stretch, shear is as stiff as dilation, and bending follows from the size of the
/// clusters. The errors are the difference between the model and the tissue. The force is elasticity and pressure on
/// the disc at the ends of the frames. Times are those of whole frames.
/// @param substeps  out: per frame
Trajectory runShapeMatching(const BenchWall& wall, const Pull& pull, int& substeps);

}  // namespace vibe::benchmarks
