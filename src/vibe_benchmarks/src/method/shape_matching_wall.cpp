#include "method/trajectory.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "vibe_core/constraints/gas.hpp"
#include "vibe_core/simulation/simulation.hpp"

namespace vibe::benchmarks {
namespace {

constexpr int kStepsPerFrame = 17;
constexpr double kSettlingTime = 2;  // time to reach the inflated start [s]

std::shared_ptr<const Model> makeModel(const BenchWall& wall, bool tool_held) {
  auto model = std::make_shared<Model>();
  const std::size_t count = wall.mesh.vertices.size();
  model->scene.step_period = kFrame / kStepsPerFrame;
  TissueScene& tissue = model->scene.tissue;
  tissue.model = "shape_matching";
  tissue.density = kWallDensity;
  tissue.young_modulus = kWallTissue.young_modulus;
  tissue.poisson_ratio = kWallTissue.poisson_ratio;
  tissue.mass_damping = wall.body.mass_damping;
  model->scene.gas = GasScene{};
  Organ& organ = model->organ;
  organ.surface = wall.mesh;
  organ.region.assign(count, Region::Body);
  organ.wall.assign(count, Wall::Anterior);
  organ.end.assign(count, End::None);
  organ.thickness.assign(count, kWallThickness);
  finishModel("", *model);
  for (std::size_t n = 0; n < count; ++n)
    if (wall.body.fixed[n] != 0) model->inverse_mass[n] = 0;
  if (tool_held)
    for (const int node : wall.tool) model->inverse_mass[node] = 0;
  return model;
}

/// A simulation of the wall. Gas is added or removed at every step to keep its pressure constant.
class MatchedWall {
 public:
  explicit MatchedWall(const BenchWall& wall)
      : wall_(wall), simulation_(makeModel(wall, false), SimulationSettings::study(1)) {}

  void holdTool() {
    State state = simulation_.state();
    for (const int node : wall_.tool) {
      held_.push_back(place(node));
      state.vx[node] = state.vy[node] = state.vz[node] = 0;
    }
    simulation_.replaceModel(makeModel(wall_, true));
    simulation_.replaceState(std::move(state));
  }

  /// @param distance  of the disc from its initial position [m]
  void step(double distance) {
    State& state = simulation_.editState();
    for (std::size_t i = 0; i < held_.size(); ++i) {
      const Eigen::Vector3d to = held_[i] + distance * wall_.pull_direction;
      const int node = wall_.tool[i];
      state.x[node] = to.x(), state.y[node] = to.y(), state.z[node] = to.z();
    }
    state.gas_amount = gasAmount(wall_.pressure, state.volume);
    simulation_.step(StepInput{});
  }

  BodyMotion motion() const {
    const State& state = simulation_.state();
    BodyMotion motion(wall_.body);
    motion.x = {state.x, state.y, state.z};
    motion.v = {state.vx, state.vy, state.vz};
    return motion;
  }

  /// Force of the disc on the wall along the pull, against elasticity and pressure [N].
  double force() const {
    const State& state = simulation_.state();
    const std::size_t count = state.x.size();
    std::vector<double> fx(count), fy(count), fz(count);
    simulation_.model().tissue->addForces(state, fx.data(), fy.data(), fz.data());
    for (const auto& t : wall_.mesh.triangles) {
      const Eigen::Vector3d third = wall_.pressure / 6 * (place(t[1]) - place(t[0])).cross(place(t[2]) - place(t[0]));
      for (const int n : t) fx[n] += third.x(), fy[n] += third.y(), fz[n] += third.z();
    }
    double force = 0;
    for (const int n : wall_.tool) force -= wall_.pull_direction.dot(Eigen::Vector3d(fx[n], fy[n], fz[n]));
    return force;
  }

  int substeps() const { return simulation_.model().substeps * kStepsPerFrame; }

 private:
  Eigen::Vector3d place(int n) const {
    const State& state = simulation_.state();
    return {state.x[n], state.y[n], state.z[n]};
  }

  const BenchWall& wall_;
  Simulation simulation_;
  std::vector<Eigen::Vector3d> held_;
};

}  // namespace

Trajectory runShapeMatching(const BenchWall& wall, const Pull& pull, int& substeps) {
  MatchedWall body(wall);
  for (int s = 0; s < static_cast<int>(kSettlingTime / kFrame) * kStepsPerFrame; ++s) body.step(0);
  Trajectory trajectory;
  trajectory.frames.push_back(body.motion());
  body.holdTool();
  const int frames = static_cast<int>(std::lround((pull.duration + pull.hold) / kFrame));
  for (int frame = 0; frame < frames; ++frame) {
    const double before = threadMilliseconds();
    for (int s = 1; s <= kStepsPerFrame; ++s)
      body.step(pull.at(kFrame * (frame + static_cast<double>(s) / kStepsPerFrame)));
    trajectory.times.push_back(threadMilliseconds() - before);
    trajectory.frames.push_back(body.motion());
    trajectory.force.push_back(body.force());
    for (const auto& x : trajectory.frames.back().x)
      for (const double value : x) trajectory.finite = trajectory.finite && std::isfinite(value);
  }
  substeps = body.substeps();
  return trajectory;
}

}  // namespace vibe::benchmarks
