#include "trainee/picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "common/elementary.hpp"
#include "procedure/needle.hpp"
#include "trainee/ik_solution.hpp"

namespace vibe {

std::optional<NeedleView> lookAtNeedle(const Model& model, const Observation& seen) {
  std::vector<double> x, y, z;
  for (const Eigen::Vector3d& p : seen.wall) x.push_back(p.x()), y.push_back(p.y()), z.push_back(p.z());
  // the path is fixed to the tip, which is seen where it is, also if the scope gives way
  std::vector<Eigen::Isometry3d> poses;
  model.tool->forwardKinematics(seen.joints, poses);
  const auto [begin, end] = needlePath(model, poses);
  const Eigen::Isometry3d from_tip = poses[model.tip_link].inverse();
  const auto inWorld = [&](const Eigen::Vector3d& p) {
    return Eigen::Vector3d(seen.tip + seen.tip_turn * (from_tip * p));
  };
  const SurfaceView wall{model.organ.surface.triangles, x, y, z};
  const DeepestPoint deepest = deepestPoint(wall, inWorld(begin), inWorld(end));
  if (deepest.triangle < 0) return {};
  NeedleView view;
  const auto& corners = model.organ.surface.triangles[deepest.triangle];
  for (int corner : corners) view.thickness += model.organ.thickness[corner] / 3;
  view.depth = deepest.distance + 0.5 * view.thickness;
  view.where = nearestIn(deepest.triangle, deepest.point, model.organ.surface.triangles, seen.wall);
  return view;
}

namespace {

constexpr double kPatch = 5e-3;  // radius of what the helix holds, which moves as one [m]

// Displacement of a membrane around a point load, over that of the load; squares of lengths, in a loop over the wall.
double following(double distance2, double none2) {
  if (distance2 >= none2) return 0;
  if (distance2 <= kPatch * kPatch) return 1;
  return math::log(none2 / distance2) / math::log(none2 / (kPatch * kPatch));
}

}  // namespace

std::optional<NeedleView> imagineNeedle(const Model& model, const Observation& seen, const ImaginedDraw& draw) {
  const auto& triangles = model.organ.surface.triangles;
  const Eigen::Vector3d held = positionOf(draw.held, triangles, seen.wall);
  const Eigen::Vector3d outward = outwardAt(draw.held, triangles, seen.wall);
  Observation imagined = seen;
  imagined.tip_turn = draw.turn;
  imagined.tip = held + kHelixDepth * outward - draw.turn * helixInTip(draw.from);
  const Eigen::Vector3d pull = draw.turn * Eigen::Vector3d(draw.drawn - draw.from, 0, 0);
  const double none2 = draw.follows * draw.follows;
  for (Eigen::Vector3d& p : imagined.wall) p += following((p - held).squaredNorm(), none2) * pull;
  return lookAtNeedle(model, imagined);
}

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
