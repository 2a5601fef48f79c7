#include "method/wall.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fem/bench_mesh.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/solver/implicit_stepper.hpp"
#include "vibe_core/tissue/shell.hpp"

namespace vibe::benchmarks {
namespace {

constexpr double kRadius = 0.04325, kHalfLength = 0.12325;  // of the middle surface
constexpr double kDamping = 30, kDiscRadius = 0.005;

void holdEnds(std::size_t count, std::vector<char>& fixed, const std::vector<Eigen::Vector3d>& nodes) {
  std::vector<int> order(nodes.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return std::abs(nodes[a].z()) > std::abs(nodes[b].z()); });
  fixed.assign(nodes.size(), 0);
  for (std::size_t i = 0; i < count; ++i) fixed[order[i]] = 1;
}

void settleOrFail(const ImplicitStepper& stepper, MotionView motion, BodyLoads& loads, StepperWorkspace& scratch,
                  double tolerance, const char* what) {
  const StepOutcome outcome = stepper.settle(motion, loads, scratch, tolerance);
  if (!outcome.finite || !outcome.converged)
    throw Error(std::string("method table: ") + what + " does not converge; the solver is at fault.");
}

}  // namespace

BenchWall makeWall(int nodes) {
  const BenchMesh mesh = makeEllipsoid(kRadius, kHalfLength, nodes);
  BenchWall wall;
  wall.mesh = {mesh.nodes, mesh.triangles};
  wall.rest_volume = enclosedVolume(wall.mesh);
  ShellMesh shell;
  shell.nodes = mesh.nodes;
  shell.triangles = mesh.triangles;
  shell.thickness.assign(mesh.triangles.size(), kWallThickness);
  shell.materials = {kWallTissue};
  holdEnds(std::max<std::size_t>(6, mesh.nodes.size() / 60), shell.fixed, mesh.nodes);
  wall.body.fixed = shell.fixed;
  const auto elements = std::make_shared<ShellElements>(std::move(shell));
  wall.body.elements = elements;
  wall.body.shell = elements.get();
  wall.body.rest = mesh.nodes;
  wall.body.mass = elements->lumpedMass(kWallDensity);
  wall.body.mass_damping = kDamping;
  const Eigen::Vector3d place(kRadius, 0, 0);
  int middle = 0;
  for (int n = 0; n < nodes; ++n)
    if ((mesh.nodes[n] - place).norm() < (mesh.nodes[middle] - place).norm()) middle = n;
  for (int n = 0; n < nodes; ++n)
    if ((mesh.nodes[n] - mesh.nodes[middle]).norm() <= kDiscRadius) wall.tool.push_back(n);
  wall.pull_direction = -Eigen::Vector3d(mesh.nodes[middle].x(), mesh.nodes[middle].y(), 0).normalized();
  return wall;
}

BodyLoads pressureLoads(const BenchWall& wall, double pressure) {
  BodyLoads loads;
  loads.gas.control = GasLoad::Control::Pressure;
  loads.gas.pressure = pressure;
  loads.gas.volume = wall.rest_volume;
  return loads;
}

BodyLoads wallLoads(const BenchWall& wall, const BodyMotion& start, double distance) {
  BodyLoads loads = pressureLoads(wall, wall.pressure);
  for (const int node : wall.tool) {
    for (int axis = 0; axis < 3; ++axis) {
      LinearConstraint constraint;
      constraint.node = {node};
      constraint.coefficient = {Eigen::Vector3d::Unit(axis)};
      constraint.target = start.x[axis][node] + distance * wall.pull_direction[axis];
      loads.constraints.push_back(constraint);
    }
  }
  return loads;
}

double toolForce(const BenchWall& wall, const BodyLoads& loads) {
  double force = 0;
  for (std::size_t i = 0; i < loads.constraints.size(); ++i)
    force += loads.constraints[i].force * wall.pull_direction[static_cast<Eigen::Index>(i % 3)];
  return force;
}

BodyMotion inflate(const BenchWall& wall, double tolerance) {
  const ImplicitStepper stepper(wall.body, StepSettings{});
  const auto scratch = stepper.makeWorkspace();
  BodyMotion motion(wall.body);
  for (int k = 1; k <= 5; ++k) {
    BodyLoads loads = pressureLoads(wall, wall.pressure * k / 5);
    settleOrFail(stepper, motion.view(), loads, *scratch, k == 5 ? tolerance : 1e-5, "the inflated wall");
  }
  return motion;
}

BodyMotion pulledEquilibrium(const BenchWall& wall, const BodyMotion& start, double distance, double tolerance,
                             double& force) {
  const ImplicitStepper stepper(wall.body, StepSettings{});
  const auto scratch = stepper.makeWorkspace();
  BodyMotion motion = start;
  const int stages = std::max(1, static_cast<int>(std::lround(distance / 0.004)));
  for (int k = 1; k <= stages; ++k) {
    BodyLoads loads = wallLoads(wall, start, distance * k / stages);
    settleOrFail(stepper, motion.view(), loads, *scratch, k == stages ? tolerance : 1e-6, "the pulled wall");
    force = toolForce(wall, loads);
  }
  return motion;
}

double distanceBetween(const BodyMotion& a, const BodyMotion& b) {
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t n = 0; n < a.x[k].size(); ++n) sum += (a.x[k][n] - b.x[k][n]) * (a.x[k][n] - b.x[k][n]);
  return std::sqrt(sum);
}

}  // namespace vibe::benchmarks
