#include "vibe_core/simulation/tip_motion.hpp"

#include <Eigen/Geometry>
#include <vector>

#include "contact/tool_jacobian.hpp"
#include "geometry/ray.hpp"

namespace vibe {
namespace {

std::vector<Eigen::Isometry3d> linkPoses(const Model& model, const State& state) {
  std::vector<Eigen::Isometry3d> poses;
  model.tool->forwardKinematics(state.joints, state.tool_displacement, poses);
  return poses;
}

}  // namespace

// A link that turns by w moves the end of an arm r by w x r, and w is half the sum of e x (w x e) over three axes e.
TipJacobian tipJacobian(const Model& model, const State& state) {
  const std::vector<Eigen::Isometry3d> poses = linkPoses(model, state);
  const ShaftBend bend = model.tool->shaftBend(state.joints, state.tool_displacement);
  const Eigen::Vector3d tip = poses[model.tip_link].translation();
  const auto at = [&](const Eigen::Vector3d& point) -> Eigen::Matrix<double, 3, kScopeJointCount> {
    return yieldJacobian(*model.tool, poses, bend, model.tip_link, point).leftCols<kScopeJointCount>();
  };
  const Eigen::Matrix3d to_world = model.tool_base.linear();
  const Eigen::Matrix<double, 3, kScopeJointCount> linear = at(tip);
  TipJacobian jacobian = TipJacobian::Zero();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(k);
    const Eigen::Matrix<double, 3, kScopeJointCount> arm = at(tip + axis) - linear;
    for (int j = 0; j < kScopeJointCount; ++j) jacobian.col(j).tail<3>() += 0.5 * axis.cross(arm.col(j));
  }
  jacobian.bottomRows<3>() = (to_world * jacobian.bottomRows<3>()).eval();
  jacobian.topRows<3>() = to_world * linear;
  return jacobian;
}

std::optional<WallSight> lookAhead(const Model& model, const State& state) {
  const Eigen::Isometry3d tip = model.tool_base * linkPoses(model, state)[model.tip_link];
  const Eigen::Vector3d view = tip.linear().col(0);
  const SurfaceView wall{model.organ.surface.triangles, state.x, state.y, state.z};
  const Ray ray(tip.translation() - model.particle_radius * view, view, model.particle_radius + kSightReach);
  const RayHit hit = firstHit(ray, wall);
  if (hit.triangle < 0) return {};
  const Eigen::Vector3d normal = areaVector(wall, wall.triangles[hit.triangle]).normalized();
  WallSight sight;
  sight.triangle = hit.triangle;
  sight.point = ray.at(hit.distance);
  sight.normal = normal.dot(view) > 0 ? Eigen::Vector3d(-normal) : normal;
  sight.distance = hit.distance - model.particle_radius;
  return sight;
}

}  // namespace vibe
