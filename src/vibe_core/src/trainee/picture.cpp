#include "trainee/picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "arithmetic/elementary.hpp"
#include "procedure/needle.hpp"
#include "tool_contact/surface_contacts.hpp"
#include "tool_contact/tool_approach.hpp"
#include "tool_contact/tool_collision.hpp"
#include "trainee/ik_solution.hpp"
#include "vibe_core/geometry/triangle_tree.hpp"

namespace vibe {

namespace {

/// Triangles of a wall with their corners, in numbers of their own.
struct PartOfWall {
  std::vector<int> triangle, vertex;  // in the whole, the former ascending
  std::vector<std::array<int, 3>> triangles;
  std::vector<double> x, y, z;  // [m]
};

constexpr double kReachSpare = 1e-6;  // far above rounding, and what deepestPoint() adds to its reach [m]

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

// All triangles but those with three corners beyond one side of a box.
PartOfWall partWithin(const Eigen::AlignedBox3d& box, const std::vector<std::array<int, 3>>& triangles,
                      const std::vector<Eigen::Vector3d>& wall) {
  std::vector<std::uint8_t> sides(wall.size());
  for (std::size_t v = 0; v < wall.size(); ++v) sides[v] = sidesBeyond(box, wall[v]);
  PartOfWall part;
  std::vector<int> number(wall.size(), -1);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& n = triangles[t];
    if ((sides[n[0]] & sides[n[1]] & sides[n[2]]) != 0) continue;
    part.triangle.push_back(static_cast<int>(t));
    std::array<int, 3>& corners = part.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      int& known = number[n[k]];
      if (known < 0) {
        known = static_cast<int>(part.vertex.size());
        part.vertex.push_back(n[k]);
      }
      corners[k] = known;
    }
  }
  return part;
}

/// Where a particle of the wall is imagined.
using Imagined = std::function<Eigen::Vector3d(int)>;

// @returns the square of the distance of a point from the farther end
double reach2To(const Eigen::Vector3d& p, const Path& path) {
  return std::max((p - path.first).squaredNorm(), (p - path.second).squaredNorm());
}

// deepestPoint() looks no farther from the path than some particle is imagined from both ends.
// @param reach2  square of such a distance
// @param pull  each particle is imagined on the way by this from where it is
std::optional<NeedleView> viewOfNeedle(const Model& model, const std::vector<Eigen::Vector3d>& wall, const Path& path,
                                       double reach2, const Eigen::Vector3d& pull, const Imagined& imagined) {
  const auto& triangles = model.organ.surface.triangles;
  const double reach = std::sqrt(reach2) + kReachSpare;
  const Eigen::AlignedBox3d box(path.first.cwiseMin(path.second).array() - reach - pull.array().max(0),
                                path.first.cwiseMax(path.second).array() + reach - pull.array().min(0));
  PartOfWall part = partWithin(box, triangles, wall);
  for (const int v : part.vertex) {
    const Eigen::Vector3d p = imagined(v);
    part.x.push_back(p.x()), part.y.push_back(p.y()), part.z.push_back(p.z());
  }
  const SurfaceView view_of_wall{part.triangles, part.x, part.y, part.z};
  const DeepestPoint deepest = deepestPoint(view_of_wall, path.first, path.second);
  if (deepest.triangle < 0) return {};
  const int triangle = part.triangle[deepest.triangle];
  NeedleView view;
  for (int corner : triangles[triangle]) view.thickness += model.organ.thickness[corner] / 3;
  view.depth = deepest.distance + 0.5 * view.thickness;
  const auto& [a, b, c] = part.triangles[deepest.triangle];
  view.where =
      nearestIn(triangle, deepest.point, view_of_wall.position(a), view_of_wall.position(b), view_of_wall.position(c));
  return view;
}

}  // namespace

std::optional<NeedleView> lookAtNeedle(const Model& model, const Observation& seen) {
  const Path path = pathOfNeedle(model, seen.joints, seen.tip, seen.tip_turn);
  double reach2 = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& p : seen.wall) reach2 = std::min(reach2, reach2To(p, path));
  return viewOfNeedle(model, seen.wall, path, reach2, Eigen::Vector3d::Zero(), [&](int v) { return seen.wall[v]; });
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
  const auto imagined = [&](int v) -> Eigen::Vector3d {
    return seen.wall[v] + following((seen.wall[v] - held).squaredNorm(), none2) * pull;
  };
  const Path path = pathOfNeedle(model, seen.joints, tip, draw.turn);
  double reach2 = std::numeric_limits<double>::infinity();
  for (const int v : triangles[draw.held.triangle]) reach2 = std::min(reach2, reach2To(imagined(v), path));
  std::optional<NeedleView> view = viewOfNeedle(model, seen.wall, path, reach2, pull, imagined);
  if (view) view->outward = outward;
  return view;
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

// Each particle in the tool counts with its part of the wall and its depth.
double overlapWithWall(const Model& model, const std::vector<Eigen::Vector3d>& wall, const TraineeHand::Joints& joints,
                       const std::function<bool(int)>& may_touch) {
  std::vector<Eigen::Isometry3d> poses;
  model.tool->forwardKinematics(joints, poses);
  for (Eigen::Isometry3d& pose : poses) pose = model.tool_base * pose;
  std::vector<double> x, y, z;
  for (const Eigen::Vector3d& p : wall) x.push_back(p.x()), y.push_back(p.y()), z.push_back(p.z());
  ToolCollision collision(*model.tool);
  collision.findCandidates(poses, x.data(), y.data(), z.data(), static_cast<int>(wall.size()), 0);
  const std::vector<char> passable = passableVertices(model.organ), on_tip = shapesOnTip(*model.tool);
  double sum = 0;
  forEachDeepest(collision.findContacts(poses, x.data(), y.data(), z.data(), 0), [&](const Contact& contact) {
    if (passable[contact.particle] != 0) return;
    if (on_tip[contact.shape] != 0 && may_touch && may_touch(contact.particle)) return;
    sum -= contact.distance * model.area[contact.particle];
  });
  return sum;
}

}  // namespace vibe
