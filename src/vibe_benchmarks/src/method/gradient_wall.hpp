#pragma once
#include <limits>
#include <ostream>
#include <vector>

#include "method/trajectory.hpp"

namespace vibe::benchmarks {

/// One setting of the gradient-domain deformation.
struct PatchChoice {
  const char* name;
  double radius;  ///< of the patch around the disc [m]; infinity: the whole wall
  int turns;      ///< number of improvements of the rotations per frame
};
constexpr double kWholeWall = std::numeric_limits<double>::infinity();
constexpr PatchChoice kPatchChoices[] = {{"60 Hz, patch of 50 mm", 0.05, 1},
                                         {"60 Hz, whole wall, no turn", kWholeWall, 0},
                                         {"60 Hz, whole wall, 1 turn", kWholeWall, 1}};

/// The same mesh and pull with the gradient-domain deformation of a patch around the disc; held nodes of the body stay
/// held. Each frame is a shape without force, pressure or inertia. Its errors are the difference from the tissue. Times
/// are those of whole frames; the first one is the construction of the patch.
Trajectory runGradient(const BenchWall& wall, const BodyMotion& start, const Pull& pull, const PatchChoice& choice);

/// The wall on a foundation of 5 kPa/m, as in a scene, with the disc pushed outwards by 5 and by 10 mm: gradient-domain
/// shapes compared with equilibria of the shell by the implicit solver.
std::vector<ResultRow> runPokes(int nodes, std::ostream& log);

}  // namespace vibe::benchmarks
