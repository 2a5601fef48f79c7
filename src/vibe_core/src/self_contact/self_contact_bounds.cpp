#include "self_contact/self_contact_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vibe {

namespace {

// Vertices that are compared at once, a size of an array: most blocks of so many need nothing.
constexpr Eigen::Index kBlock = 128;
using Block = Eigen::Array<double, Eigen::Dynamic, 1, 0, kBlock, 1>;

using Components = std::array<Eigen::Map<const Eigen::ArrayXd>, 3>;
Components componentsOf(const SelfContactBounds::NodeVectors& x, std::size_t count) {
  const auto size = static_cast<Eigen::Index>(count);
  return {Eigen::Map<const Eigen::ArrayXd>(x[0], size), Eigen::Map<const Eigen::ArrayXd>(x[1], size),
          Eigen::Map<const Eigen::ArrayXd>(x[2], size)};
}
Components componentsOf(const std::array<std::vector<double>, 3>& x) {
  return componentsOf({x[0].data(), x[1].data(), x[2].data()}, x[0].size());
}

}  // namespace

SelfContactBounds::SelfContactBounds(const std::vector<std::array<int, 3>>& triangles, std::vector<int> part,
                                     double slack)
    : policy_(stepPolicy()),
      triangles_(triangles),
      part_(std::move(part)),
      part_moves_(part_.empty() ? 0 : *std::max_element(part_.begin(), part_.end()) + 1),
      slack_(slack),
      centre_(part_.size(), Eigen::Vector3d::Zero()),
      radius_(part_.size(), -1),
      radius_squared_(part_.size(), -1),
      cone_(triangles.size()),
      loose_cone_(triangles.size(), 0),
      start_(4 * part_.size()),
      end_(4 * part_.size()) {
  const std::size_t vertices = part_.size();
  const std::size_t padded = (triangles.size() + kConeGroup - 1) / kConeGroup * kConeGroup;
  for (std::size_t k = 0; k < 3; ++k) {
    middle_[k].assign(vertices, 0);
    checked_[k].assign(vertices, 0);
    normal_[k].assign(padded, 0);
  }
  moved_.reserve(vertices);
  large_balls_.reserve(vertices);
  turned_.reserve(triangles.size());
  turn_.assign(padded, 0);
  cosine_.assign(padded, 2);
}

void SelfContactBounds::reset() {
  std::fill(radius_squared_.begin(), radius_squared_.end(), -1.0);
  std::fill(cosine_.begin(), cosine_.end(), 2.0F);
  cone_safe_move_ = safe_move_ = -1;
  max_radius_ = 0;
}

bool SelfContactBounds::adapt(const NodeVectors& start, const NodeVectors& end) {
  moved_.clear();
  turned_.clear();
  if (allHoldAt(end)) return true;
  // A ball that was made for a fast path finds too much once its vertex is slow: it is made anew.
  if (start != end)
    for (const int i : large_balls_)
      if (radius_[i] > policy_.ball_too_large * radiusFor((vectorOf(end, i) - vectorOf(start, i)).norm()))
        radius_squared_[i] = -1;
  if (!adaptBalls(start, end)) {
    reset();
    return false;
  }
  // Cones are looked at only where vertices have moved farther than any triangle can bear.
  if (cone_safe_move_ < 0 || farthest_squared_ > cone_safe_move_ * cone_safe_move_ ||
      (any_wide_cone_ && start != end)) {
    adaptCones(start, end);
    farthest_squared_ = 0;
  }
  // The next call can leave early unless something waits to be made smaller.
  safe_move_ = large_balls_.empty() && !any_wide_cone_
                   ? std::min(cone_safe_move_, ball_safe_move_ - std::sqrt(farthest_squared_))
                   : -1;
  return true;
}

// Whether every bound holds at positions, from one pass over the vertices: the usual case where hardly anything moves.
bool SelfContactBounds::allHoldAt(const NodeVectors& end) const {
  if (!(safe_move_ > 0)) return false;
  const Components x = componentsOf(end, radius_.size()), checked = componentsOf(checked_);
  Block squares;
  for (Eigen::Index first = 0, n = x[0].size(); first < n; first += kBlock) {
    const Eigen::Index count = std::min(kBlock, n - first);
    const auto square = [&](std::size_t k) {
      return (x[k].segment(first, count) - checked[k].segment(first, count)).square();
    };
    squares = square(0) + square(1) + square(2);
    // The sum is more than enough, faster than the largest, and not finite where a position is not.
    if (!(squares.sum() <= safe_move_ * safe_move_)) return false;
  }
  return true;
}

bool SelfContactBounds::adaptBalls(const NodeVectors& start, const NodeVectors& end) {
  if (!listOutside(end)) return false;
  if (moved_.empty()) return true;
  addNeighbours(start, end);
  large_balls_.erase(
      std::remove_if(large_balls_.begin(), large_balls_.end(), [this](int i) { return radius_squared_[i] < 0; }),
      large_balls_.end());
  for (const int i : moved_) moveBall(i, start, end);
  return true;
}

// Lists the vertices that have left their balls in moved_, and measures how far the others are from that.
// @returns false if a position is not finite
bool SelfContactBounds::listOutside(const NodeVectors& end) {
  const auto n = static_cast<Eigen::Index>(radius_.size());
  const Components x = componentsOf(end, radius_.size()), middle = componentsOf(middle_),
                   checked = componentsOf(checked_);
  const Eigen::Map<const Eigen::ArrayXd> allowed(radius_squared_.data(), n);
  farthest_squared_ = 0;
  double least = std::numeric_limits<double>::infinity();
  Block squares;
  for (Eigen::Index first = 0; first < n; first += kBlock) {
    const Eigen::Index count = std::min(kBlock, n - first);
    const auto square = [&](const Components& from, std::size_t k) {
      return (x[k].segment(first, count) - from[k].segment(first, count)).square();
    };
    // The cones ask how far vertices are from where their normals were last looked at.
    squares = square(checked, 0) + square(checked, 1) + square(checked, 2);
    farthest_squared_ = std::max(farthest_squared_, squares.maxCoeff());
    // A ball fails where distance^2 - radius^2 is above 0, and where its radius^2 was set below 0.
    squares = square(middle, 0) + square(middle, 1) + square(middle, 2) - allowed.segment(first, count);
    if (!std::isfinite(squares.sum())) return false;
    least = std::min(least, -squares.maxCoeff());
    if (squares.maxCoeff() <= 0) continue;
    for (Eigen::Index i = 0; i < count; ++i)
      if (squares[i] > 0) moved_.push_back(static_cast<int>(first + i));
  }
  // radius - distance is more than (radius^2 - distance^2) / (2 radius).
  ball_safe_move_ = moved_.empty() ? least / (2 * max_radius_) : -1;
  return true;
}

// Adds vertices of the same parts that have left the centres of their balls behind: what is near a part is searched
// once for all of them, and they would leave their balls soon.
void SelfContactBounds::addNeighbours(const NodeVectors& start, const NodeVectors& end) {
  std::fill(part_moves_.begin(), part_moves_.end(), char{0});
  for (const int i : moved_) part_moves_[part_[i]] = 1;
  for (std::size_t k = 0, count = moved_.size(); k < part_.size(); ++k) {
    const int i = static_cast<int>(k);
    // Only the first `count` entries are ascending; those behind them were added here.
    if (part_moves_[part_[k]] == 0 || (count > 0 && std::binary_search(moved_.begin(), moved_.begin() + count, i)))
      continue;
    const Eigen::Vector3d to = vectorOf(end, i);
    if ((to - centre_[k]).dot(to - vectorOf(start, i)) > 0) moved_.push_back(i);
  }
}

// The centre lies ahead of the vertex, so that it stays in the ball for long.
void SelfContactBounds::moveBall(int vertex, const NodeVectors& start, const NodeVectors& end) {
  const Eigen::Vector3d from = vectorOf(start, vertex), way = vectorOf(end, vertex) - from;
  const double length = way.norm();
  Eigen::Vector3d& centre = centre_[vertex];
  double& radius = radius_[vertex];
  radius = radiusFor(length);
  centre = from + std::max(0.5, length > 0 ? policy_.ball_lead * radius / length : 0) * way;
  for (int k = 0; k < 3; ++k) middle_[k][vertex] = centre[k];
  radius_squared_[vertex] = radius * radius;
  max_radius_ = std::max(max_radius_, radius);
  if (radius > policy_.ball_too_large * slack_) large_balls_.push_back(vertex);
}

// @param length  of the path that the ball is for [m]
double SelfContactBounds::radiusFor(double length) const {
  return std::max(std::clamp(policy_.ball_steps * length, slack_, policy_.ball_largest * slack_),
                  0.5 * length + policy_.ball_fast_spare * slack_);
}

}  // namespace vibe
