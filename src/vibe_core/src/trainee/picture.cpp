#include "trainee/picture.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "common/elementary.hpp"
#include "trainee/ik_solution.hpp"

namespace vibe {

namespace {

constexpr double kOblique = 0.7;  // tangent of the angle at which the wall is seen, if not straight; design choice

View viewFrom(const Eigen::Vector3d& place, const Eigen::Vector3d& tip, const Eigen::Vector3d& ahead) {
  const Eigen::Vector3d way = place - tip;
  return {way.norm(), math::acos(std::clamp(way.normalized().dot(ahead), -1.0, 1.0))};
}

View viewWith(const TraineeHand::Joints& joints, const Eigen::Vector3d& place, const Model& model) {
  std::vector<Eigen::Isometry3d> poses;
  model.tool->forwardKinematics(joints, poses);
  const Eigen::Isometry3d tip = model.tool_base * poses[model.tip_link];
  return viewFrom(place, tip.translation(), tip.linear().col(0));
}

}  // namespace

View viewOf(const Eigen::Vector3d& place, const Observation& seen) {
  return viewFrom(place, seen.tip, seen.tip_turn * Eigen::Vector3d::UnitX());
}

TraineeHand::Joints bestView(const Eigen::Vector3d& place, const Eigen::Vector3d& outward, double distance,
                             Operator& me) {
  const Eigen::Vector3d side = outward.unitOrthogonal(), other = outward.cross(side);
  TraineeHand::Joints best = me.hand.joints();
  double min = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& tilt : {Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 0), Eigen::Vector2d(-1, 0),
                                      Eigen::Vector2d(0, 1), Eigen::Vector2d(0, -1)}) {
    const Eigen::Vector3d ahead = (outward + kOblique * (tilt.x() * side + tilt.y() * other)).normalized();
    const IkSolution aim =
        aimAt(me.model(), place - distance * ahead, ahead, Eigen::Vector3d::Zero(), me.hand.joints());
    const View view = viewWith(aim.joints, place, me.model());
    const double cost = view.angle + std::abs(math::log(view.distance / distance));
    if (cost < min) min = cost, best = aim.joints;
  }
  return best;
}

}  // namespace vibe
