#include "method/shape_matching_wall.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "constraints/gas.hpp"
#include "vibe_core/simulation/simulator.hpp"

namespace vibe {
namespace {

constexpr int kStepsPerFrame = 17;
constexpr double kSettling = 2;  // until the inflated start [s]

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

/// A model with its state. The gas is let in or out at every step, so that its pressure is constant.
class MatchedWall {
 public:
  explicit MatchedWall(const BenchWall& wall) : wall_(wall), model_(makeModel(wall, false)) {
    state_ = initialState(*model_, 1);
    makeWorkspace();
  }

  void holdTool() {
    model_ = makeModel(wall_, true);
    makeWorkspace();
    for (const int node : wall_.tool) {
      held_.push_back(place(node));
      state_.vx[node] = state_.vy[node] = state_.vz[node] = 0;
    }
  }

  /// @param distance  of the disc from where it was taken [m]
  void step(double distance) {
    for (std::size_t i = 0; i < held_.size(); ++i) {
      const Eigen::Vector3d to = held_[i] + distance * wall_.pull_direction;
      const int node = wall_.tool[i];
      state_.x[node] = to.x(), state_.y[node] = to.y(), state_.z[node] = to.z();
    }
    state_.gas_amount = gasAmount(wall_.pressure, state_.volume);
    events_.clear();
    vibe::step(*model_, state_, StepInput{}, *workspace_, events_);
  }

  BodyMotion motion() const {
    BodyMotion motion(wall_.body);
    motion.x = {state_.x, state_.y, state_.z};
    motion.v = {state_.vx, state_.vy, state_.vz};
    return motion;
  }

  /// Of the disc on the wall along the pull, against elasticity and pressure [N].
  double force() const {
    const std::size_t count = state_.x.size();
    std::vector<double> fx(count), fy(count), fz(count);
    model_->tissue->addForces(state_, fx.data(), fy.data(), fz.data());
    for (const auto& t : wall_.mesh.triangles) {
      const Eigen::Vector3d third = wall_.pressure / 6 * (place(t[1]) - place(t[0])).cross(place(t[2]) - place(t[0]));
      for (const int n : t) fx[n] += third.x(), fy[n] += third.y(), fz[n] += third.z();
    }
    double force = 0;
    for (const int n : wall_.tool) force -= wall_.pull_direction.dot(Eigen::Vector3d(fx[n], fy[n], fz[n]));
    return force;
  }

  int substeps() const { return model_->substeps * kStepsPerFrame; }

 private:
  Eigen::Vector3d place(int n) const { return {state_.x[n], state_.y[n], state_.z[n]}; }
  void makeWorkspace() { workspace_ = std::make_unique<Workspace>(*model_); }

  const BenchWall& wall_;
  std::shared_ptr<const Model> model_;
  std::unique_ptr<Workspace> workspace_;
  State state_;
  std::vector<Event> events_;
  std::vector<Eigen::Vector3d> held_;
};

}  // namespace

Trajectory runShapeMatching(const BenchWall& wall, const Pull& pull, int& substeps) {
  MatchedWall body(wall);
  for (int s = 0; s < static_cast<int>(kSettling / kFrame) * kStepsPerFrame; ++s) body.step(0);
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

}  // namespace vibe
