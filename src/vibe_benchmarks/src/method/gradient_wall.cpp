#include "method/gradient_wall.hpp"

#include <cmath>
#include <string>

#include "tissue/gradient_deformation.hpp"

namespace vibe::benchmarks {
namespace {

constexpr double kFoundation = 5e3;    // [Pa/m] of the default scene
constexpr double kTolerance = 1e-7;    // [m]
constexpr int kOperationRepeats = 20;  // of each timed operation
constexpr double kFarthest = 1e3;      // [m] beyond any wall

/// The disc first, then the held nodes of the body inside the patch.
std::vector<int> handlesOf(const BenchWall& wall, const std::vector<int>& patch) {
  std::vector<int> handles = wall.tool;
  for (const int node : patch)
    if (wall.body.fixed[node] != 0) handles.push_back(node);
  return handles;
}

/// The wall with a patch that follows the disc.
class GradientWall {
 public:
  GradientWall(const BenchWall& wall, const BodyMotion& start, const PatchChoice& choice)
      : wall_(wall),
        shape_{wall.mesh.triangles, start.x[0], start.x[1], start.x[2]},
        nodes_(patchAround(shape_, wall.tool, std::fmin(choice.radius, kFarthest))),
        handles_(handlesOf(wall, nodes_)),
        patch_(shape_, nodes_, handles_, choice.turns) {
    for (const int handle : handles_) start_.push_back(shape_.position(handle));
    targets_ = start_;
  }

  void move(double distance, BodyMotion& motion) {
    for (std::size_t h = 0; h < wall_.tool.size(); ++h) targets_[h] = start_[h] + distance * wall_.pull_direction;
    patch_.deform(targets_, positions_);
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      for (int axis = 0; axis < 3; ++axis) motion.x[axis][nodes_[i]] = positions_[i][axis];
  }

 private:
  const BenchWall& wall_;
  SurfaceView shape_;
  std::vector<int> nodes_, handles_;
  GradientDeformation patch_;
  std::vector<Eigen::Vector3d> start_, targets_, positions_;
};

ResultRow pokeRow(double distance, int nodes, const char* method, const char* setting) {
  ResultRow row;
  row.bench_case = "poke_" + std::to_string(std::lround(distance * 1000)) + "mm_bed";
  row.method = method;
  row.setting = setting;
  row.particles = nodes;
  return row;
}

ResultRow pokeByGradient(const BenchWall& wall, const BodyMotion& start, const BodyMotion& equilibrium, double distance,
                         const PatchChoice& choice) {
  ResultRow row = pokeRow(distance, static_cast<int>(wall.body.rest.size()), "gradient_domain", choice.name);
  GradientWall patch(wall, start, choice);
  BodyMotion motion = start;
  std::vector<double> times;
  for (int i = 0; i < kOperationRepeats; ++i) {
    const double before = threadMilliseconds();
    patch.move(distance, motion);
    times.push_back(threadMilliseconds() - before);
  }
  setTimes(times, row);
  row.static_error = driftApart(motion, start, equilibrium, start) / distanceBetween(equilibrium, start);
  row.state_hash = hashOf(motion);
  return row;
}

}  // namespace

Trajectory runGradient(const BenchWall& wall, const BodyMotion& start, const Pull& pull, const PatchChoice& choice) {
  Trajectory trajectory;
  trajectory.frames.push_back(start);
  const double making = threadMilliseconds();
  GradientWall patch(wall, start, choice);
  trajectory.first_time = threadMilliseconds() - making;
  BodyMotion motion = start;
  const int frames = static_cast<int>(std::lround((pull.duration + pull.hold) / kFrame));
  for (int frame = 1; frame <= frames; ++frame) {
    const double before = threadMilliseconds();
    patch.move(pull.at(kFrame * frame), motion);
    trajectory.times.push_back(threadMilliseconds() - before);
    trajectory.frames.push_back(motion);
  }
  return trajectory;
}

std::vector<ResultRow> runPokes(int nodes, std::ostream& log) {
  BenchWall wall = makeWall(nodes);
  for (const double area : vertexAreas(wall.mesh)) wall.body.foundation.push_back(kFoundation * area);
  wall.pull_direction = -wall.pull_direction;
  const BodyMotion start = inflate(wall, kTolerance);
  std::vector<ResultRow> rows;
  for (const double distance : {0.005, 0.010}) {
    log << "wall: poke by " << 1000 * distance << " mm in a foundation\n";
    double force = 0;
    const double before = threadMilliseconds();
    const BodyMotion equilibrium = pulledEquilibrium(wall, start, distance, kTolerance, force);
    rows.push_back(pokeRow(distance, nodes, "implicit", "settled"));
    setTimes({threadMilliseconds() - before}, rows.back());
    rows.back().static_error = 0;
    rows.back().state_hash = hashOf(equilibrium);
    for (const PatchChoice& choice : kPatchChoices)
      rows.push_back(pokeByGradient(wall, start, equilibrium, distance, choice));
  }
  return rows;
}

}  // namespace vibe::benchmarks
