#include "trainee/picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "common/elementary.hpp"
#include "procedure/needle.hpp"
#include "trainee/ik_solution.hpp"
#include "trainee/room.hpp"
#include "vibe_core/geometry/triangle_tree.hpp"

namespace vibe {

namespace {

/// Positions of the wall's particles, by coordinate [m].
struct Coordinates {
  explicit Coordinates(const std::vector<Eigen::Vector3d>& wall) : x(wall.size()), y(wall.size()), z(wall.size()) {
    for (std::size_t v = 0; v < wall.size(); ++v) x[v] = wall[v].x(), y[v] = wall[v].y(), z[v] = wall[v].z();
  }
  std::vector<double> x, y, z;
};

using Path = std::pair<Eigen::Vector3d, Eigen::Vector3d>;

// The path is fixed to the tip, which is seen where it is, also if the scope gives way.
Path pathOfNeedle(const Model& model, const TraineeHand::Joints& joints, const Eigen::Vector3d& tip,
                  const Eigen::Quaterniond& turn) {
  std::vector<Eigen::Isometry3d> poses;
  model.tool->forwardKinematics(joints, poses);
  const auto [begin, end] = needlePath(model, poses);
  const Eigen::Isometry3d from_tip = poses[model.tip_link].inverse();
  return {tip + turn * (from_tip * begin), tip + turn * (from_tip * end)};
}

std::optional<NeedleView> viewOfNeedle(const Model& model, const Coordinates& at, const Path& path) {
  const auto& triangles = model.organ.surface.triangles;
  const SurfaceView wall{triangles, at.x, at.y, at.z};
  const DeepestPoint deepest = deepestPoint(wall, path.first, path.second);
  if (deepest.triangle < 0) return {};
  NeedleView view;
  for (int corner : triangles[deepest.triangle]) view.thickness += model.organ.thickness[corner] / 3;
  view.depth = deepest.distance + 0.5 * view.thickness;
  const auto& [a, b, c] = triangles[deepest.triangle];
  view.where = nearestIn(deepest.triangle, deepest.point, wall.position(a), wall.position(b), wall.position(c));
  return view;
}

}  // namespace

std::optional<NeedleView> lookAtNeedle(const Model& model, const Observation& seen) {
  return viewOfNeedle(model, Coordinates(seen.wall), pathOfNeedle(model, seen.joints, seen.tip, seen.tip_turn));
}

double distanceOfWall(const Eigen::Vector3d& place, const Model& model, const Observation& seen) {
  double min = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : model.organ.surface.triangles)
    min = std::min(min, (closestPointOnTriangle(place, seen.wall[a], seen.wall[b], seen.wall[c]) - place).norm());
  return min;
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
  const Eigen::Vector3d tip = held + kHelixDepth * outward - draw.turn * helixInTip(draw.from);
  const Eigen::Vector3d pull = draw.turn * Eigen::Vector3d(draw.drawn - draw.from, 0, 0);
  const double none2 = draw.follows * draw.follows;
  Coordinates at(seen.wall);
  for (std::size_t v = 0; v < seen.wall.size(); ++v) {
    const double part = following((seen.wall[v] - held).squaredNorm(), none2);
    at.x[v] += part * pull.x(), at.y[v] += part * pull.y(), at.z[v] += part * pull.z();
  }
  return viewOfNeedle(model, at, pathOfNeedle(model, seen.joints, tip, draw.turn));
}

namespace {

constexpr double kOblique = 0.7;    // tangent of the angle at which the wall is seen, if not straight; design choice
constexpr double kGrazing = 0.2;    // sine of the angle to the wall, from which on it is seen at all; design choice
constexpr std::size_t kTilts = 4;   // in obliqueWays(), which come first
constexpr double kHindrance = 2e7;  // 0.05 mL of wall in the way count as a radian; design choice [1/m^3]
constexpr int kTurns = 12;          // of the device around its axis, where it has no room

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

std::vector<Eigen::Vector3d> obliqueWays(const Eigen::Vector3d& place, const Eigen::Vector3d& outward,
                                         const Model& model) {
  const Eigen::Vector3d side = outward.unitOrthogonal(), other = outward.cross(side);
  std::vector<Eigen::Vector3d> ways;
  for (const Eigen::Vector3d& tilt : {side, Eigen::Vector3d(-side), other, Eigen::Vector3d(-other)})
    ways.push_back((outward + kOblique * tilt).normalized());
  const Eigen::Vector3d from_entry = (place - model.tool_base.translation()).normalized();
  ways.push_back((outward + from_entry).normalized());
  if (from_entry.dot(outward) > kGrazing) ways.push_back(from_entry);
  return ways;
}

namespace {

/// The best of the views that are shown to it.
class ViewChoice {
 public:
  ViewChoice(const Eigen::Vector3d& place, double distance, Operator& me)
      : place_(place), distance_(distance), me_(me), best_(me.hand.joints()) {}

  void along(const Eigen::Vector3d& ahead) {
    seen_.push_back(
        aimAt(me_.model(), place_ - distance_ * ahead, ahead, Eigen::Vector3d::Zero(), me_.hand.joints()).joints);
    consider(seen_.back());
  }

  /// The same views with the device turned around its axis, so that its arm lies elsewhere.
  void rolls() {
    for (const TraineeHand::Joints& joints : seen_)
      for (int k = 1; k < kTurns; ++k)
        if (const auto turned = rolled(me_.model(), joints, 2 * M_PI * k / kTurns)) consider(*turned);
  }

  bool hasRoom() const { return in_the_way_ < kRoomy; }
  const TraineeHand::Joints& best() const { return best_; }

 private:
  void consider(const TraineeHand::Joints& joints) {
    const View view = viewWith(joints, place_, me_.model());
    const double beside = view.angle + std::abs(math::log(view.distance / distance_));
    if (beside >= min_) return;
    const double overlap = overlapWithWall(me_.model(), me_.view().wall, joints);
    const double cost = beside + kHindrance * overlap;
    if (cost < min_) min_ = cost, best_ = joints, in_the_way_ = overlap;
  }

  const Eigen::Vector3d place_;
  const double distance_;
  Operator& me_;
  std::vector<TraineeHand::Joints> seen_;
  TraineeHand::Joints best_;
  double min_ = std::numeric_limits<double>::infinity(), in_the_way_ = 0;
};

}  // namespace

TraineeHand::Joints bestView(const Eigen::Vector3d& place, const Eigen::Vector3d& outward, double distance,
                             Operator& me) {
  const std::vector<Eigen::Vector3d> ways = obliqueWays(place, outward, me.model());
  ViewChoice choice(place, distance, me);
  choice.along(outward);
  for (std::size_t k = 0; k < ways.size() && (k < kTilts || !choice.hasRoom()); ++k) choice.along(ways[k]);
  if (!choice.hasRoom()) choice.rolls();
  return choice.best();
}

}  // namespace vibe
