#include "tool_contact/near_triangles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vibe_core/solver/step_policy.hpp"

namespace vibe {

namespace {

constexpr double kBallRounding = 1e-9;  // far above that of a position in double precision [m]
// Centre and radius together: |a + b + c| / 3 + |2 a - b - c| / 3 for three moves of length 1 is at most the root of 3,
// where a and (b + c) / 2 are 120 degrees apart.
constexpr double kEdgeMove = 1.7320509;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// @returns the longest way of a vertex [m]; infinite if a position is not finite
double longestWay(const std::array<const double*, 3>& from, const std::array<const double*, 3>& to,
                  std::size_t vertices) {
  constexpr Eigen::Index kBlock = 128;
  Eigen::Array<double, Eigen::Dynamic, 1, 0, kBlock, 1> squares;
  const auto size = static_cast<Eigen::Index>(vertices);
  double most = 0, sum = 0;
  for (Eigen::Index first = 0; first < size; first += kBlock) {
    const Eigen::Index count = std::min(kBlock, size - first);
    const auto square = [&](std::size_t k) {
      using Values = Eigen::Map<const Eigen::ArrayXd>;
      return (Values(to[k] + first, count) - Values(from[k] + first, count)).square();
    };
    squares = square(0) + square(1) + square(2);
    most = std::max(most, squares.maxCoeff());
    sum += squares.sum();
  }
  return std::isfinite(sum) ? std::sqrt(most) : kInfinity;
}

/// The largest distance along an axis between a box and a point beside it; below 0 inside.
double gapAlongAxis(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& point) {
  return (point - box.max()).cwiseMax(box.min() - point).maxCoeff();
}

double gapAlongAxis(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) {
  return (b.min() - a.max()).cwiseMax(a.min() - b.max()).maxCoeff();
}

}  // namespace

NearTriangles::NearTriangles(const SurfaceMesh& surface, const std::vector<char>& passable) {
  for (const std::array<int, 3>& n : surface.triangles)
    if (passable[n[0]] == 0 && passable[n[1]] == 0 && passable[n[2]] == 0) triangles_.push_back(n);
  for (std::vector<double>& component : wall_) component.assign(surface.vertices.size(), 0);
  balls_.reserve(triangles_.size());
  candidates_.reserve(triangles_.size());
  groups_.reserve(triangles_.size() / static_cast<std::size_t>(stepPolicy().near_group) + 1);
}

void NearTriangles::find(const SweptTool& tool, const SurfacePath& path, double reach, std::vector<Pair>& found) {
  found.clear();
  ++calls_;
  if (!holds(tool, path, reach)) list(tool, path, reach);
  // What the list holds for now is less than what it was made for: a distance when listed tells which pairs that are.
  Eigen::AlignedBox3d all = tool.box();
  all.min().array() -= reach, all.max().array() += reach;
  for (const Candidate& candidate : candidates_) {
    if (candidate.apart > needed_[candidate.shape]) continue;
    Ball& ball = balls_[candidate.ball];
    if (ball.measured != calls_) measure(all, path, ball);
    if (!ball.out_of_reach && isNear(tool, candidate.shape, ball, reach))
      found.push_back({candidate.shape, ball.triangle});
  }
}

// Corners that have moved by up to w have brought the edge of the ball around them nearer by up to kEdgeMove w.
bool NearTriangles::holds(const SweptTool& tool, const SurfacePath& path, double reach) {
  if (listed_ < 0) return false;
  const std::size_t vertices = wall_[0].size();
  const double wall = kEdgeMove * longestWay({wall_[0].data(), wall_[1].data(), wall_[2].data()}, path.from, vertices) +
                      longestWay(path.from, path.to, vertices);
  bool all = true;
  for (int s = 0; s < tool.count(); ++s) {
    const ShapePosition& before = tool_[s];
    double moved = 0;
    if (tool.hasSegment(s)) {
      const auto [a, b] = tool.segment(s, 0);
      moved = std::max((a - before.segment[0]).norm(), (b - before.segment[1]).norm()) + tool.travel(s);
    } else {
      const Eigen::AlignedBox3d& box = tool.box(s);
      moved = (box.min() - before.box.min()).cwiseAbs().cwiseMax((box.max() - before.box.max()).cwiseAbs()).maxCoeff();
    }
    needed_[s] = reach + wall + moved + kBallRounding;
    all = all && needed_[s] <= listed_;
  }
  return all;
}

void NearTriangles::list(const SweptTool& tool, const SurfacePath& path, double reach) {
  ++listings_;
  for (std::size_t k = 0; k < 3; ++k) std::copy_n(path.from[k], wall_[k].size(), wall_[k].begin());
  tool_.resize(tool.count()), needed_.resize(tool.count());
  for (int s = 0; s < tool.count(); ++s) tool_[s] = {tool.segment(s, 0), tool.box(s)};
  // holds() says what each shape needs now, whatever was listed.
  listed_ = kInfinity;
  holds(tool, path, reach);
  const double spare = stepPolicy().near_spare;
  listed_ = spare;
  for (const double needed : needed_) listed_ = std::max(listed_, needed + spare);
  listBalls(tool, path);
  candidates_.clear();
  for (int s = 0; s < tool.count(); ++s) listCandidates(tool, s);
  if (!std::isfinite(listed_)) listed_ = -1;
}

void NearTriangles::listBalls(const SweptTool& tool, const SurfacePath& path) {
  balls_.clear();
  for (int t = 0; t < static_cast<int>(triangles_.size()); ++t) {
    const auto& n = triangles_[t];
    Ball ball{t, (path.start(n[0]) + path.start(n[1]) + path.start(n[2])) / 3, 0, 0, 0, false};
    for (const int v : n) ball.radius = std::max(ball.radius, (path.start(v) - ball.centre).squaredNorm());
    ball.radius = std::sqrt(ball.radius);
    if (gapAlongAxis(tool.box(), ball.centre) - listed_ > ball.radius + kBallRounding) continue;
    balls_.push_back(ball);
  }
  groups_.clear();  // triangles that follow each other are mostly neighbours
  const auto most = static_cast<std::size_t>(stepPolicy().near_group);
  for (std::size_t first = 0; first < balls_.size(); first += most) {
    Group group{first, std::min(first + most, balls_.size()), {}};
    for (std::size_t i = group.first; i < group.last; ++i) {
      const Eigen::Vector3d near = Eigen::Vector3d::Constant(balls_[i].radius + kBallRounding);
      group.box.extend(balls_[i].centre - near);
      group.box.extend(balls_[i].centre + near);
    }
    groups_.push_back(group);
  }
}

void NearTriangles::listCandidates(const SweptTool& tool, int shape) {
  const Eigen::AlignedBox3d& box = tool.box(shape);
  const bool round = tool.hasSegment(shape);  // others are near where their boxes are
  const auto [a, b] = tool.segment(shape, 0);
  const Eigen::Vector3d middle = (a + b) / 2;
  const double around = (b - a).norm() / 2 + tool.radius(shape) + listed_ + kBallRounding;
  for (const Group& group : groups_) {
    // The cheaper test comes first; most groups end there.
    if (gapAlongAxis(group.box, box) > listed_) continue;
    if (round && group.box.squaredExteriorDistance(box) > listed_ * listed_) continue;
    for (std::size_t i = group.first; i < group.last; ++i) {
      const double far = around + balls_[i].radius;
      if (round && (balls_[i].centre - middle).squaredNorm() > far * far) continue;
      const double distance = apart(tool, shape, balls_[i]);
      if (!(distance > listed_)) candidates_.push_back({shape, static_cast<int>(i), distance});
    }
  }
}

double NearTriangles::apart(const SweptTool& tool, int shape, const Ball& ball) const {
  if (!tool.hasSegment(shape)) return gapAlongAxis(tool.box(shape), ball.centre) - ball.radius;
  const auto [a, b] = tool.segment(shape, 0);
  return (ball.centre - nearestOnSegment(a, b, ball.centre)).norm() - tool.radius(shape) - ball.radius;
}

// @param box  what the tool may reach
void NearTriangles::measure(const Eigen::AlignedBox3d& box, const SurfacePath& path, Ball& ball) const {
  const auto& n = triangles_[ball.triangle];
  // One ball serves all shapes of a call.
  ball.measured = calls_;
  ball.centre = (path.start(n[0]) + path.start(n[1]) + path.start(n[2])) / 3;
  ball.radius = ball.move = 0;
  const Eigen::Array3d low = box.min(), high = box.max();
  Eigen::Array<bool, 3, 1> below = Eigen::Array<bool, 3, 1>::Constant(true), above = below;
  for (const int v : n) {
    const Eigen::Vector3d from = path.start(v), to(path.to[0][v], path.to[1][v], path.to[2][v]);
    ball.radius = std::max(ball.radius, (from - ball.centre).squaredNorm());
    ball.move = std::max(ball.move, (path.at(v, 1) - from).squaredNorm());
    below = below && from.array() < low && to.array() < low;
    above = above && from.array() > high && to.array() > high;
  }
  ball.radius = std::sqrt(ball.radius), ball.move = std::sqrt(ball.move);
  ball.out_of_reach = below.any() || above.any() || !std::isfinite(ball.centre.sum() + ball.radius + ball.move);
}

bool NearTriangles::isNear(const SweptTool& tool, int shape, const Ball& ball, double reach) const {
  const Eigen::Vector3d low = tool.box(shape).min(), high = tool.box(shape).max();
  const double near = ball.radius + ball.move + reach;
  if (((ball.centre - high).array() > near).any() || ((low - ball.centre).array() > near).any()) return false;
  // Boxes are nearly empty around long oblique shapes: the segment decides.
  if (!tool.hasSegment(shape)) return true;
  const auto [a, b] = tool.segment(shape, 0);
  const double grown = tool.radius(shape) + tool.travel(shape) + reach;
  return (ball.centre - nearestOnSegment(a, b, ball.centre)).norm() <= grown + ball.radius + ball.move;
}

}  // namespace vibe
