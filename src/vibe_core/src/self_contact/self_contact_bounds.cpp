#include "self_contact/self_contact_bounds.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vibe {

namespace self_contact {

constexpr std::size_t kGroup = 8;  // triangles
using Group = Eigen::Array<float, kGroup, 1>;

struct Vectors {
  Group x, y, z;
  Vectors operator-(const Vectors& b) const { return {x - b.x, y - b.y, z - b.z}; }
  Vectors operator+(const Vectors& b) const { return {x + b.x, y + b.y, z + b.z}; }
  Group dot(const Vectors& b) const { return x * b.x + y * b.y + z * b.z; }
  Vectors cross(const Vectors& b) const { return {y * b.z - z * b.y, z * b.x - x * b.z, x * b.y - y * b.x}; }
};

}  // namespace self_contact

namespace {

using self_contact::Group;
using self_contact::kGroup;
using self_contact::Vectors;

// Balls, in slacks. Design choice: vertices that move together are searched anew once in about eight steps, fast ones
// more often.
constexpr double kSteps = 4;        // a ball holds for about twice so many steps [1]
constexpr double kFarthest = 1.5;   // radius for such a time, at most: more is near a larger ball
constexpr double kFastSpare = 0.5;  // of a ball around a faster path: it may end so much farther
constexpr double kLead = 0.8;       // of a ball ahead of its vertex, in radii
constexpr double kWide = 1.9;       // radius of a ball that is made smaller, over the one for its vertex now
// Width of the cones. Design choice: walls whose normals differ by less than a right angle are not compared although
// both cones are taken off the least cosine of walls that face each other [1].
constexpr double kTurn = 0.15;
constexpr double kCoarseTurn = 0.4;  // where cones cannot tell walls apart anyway
constexpr double kWideTurn = 1.5;    // of a cone that is made smaller in each step, in usual widths
constexpr float kCosineRounding =
    1e-5F;                         // of a cosine in single precision: positions to 1e-8 m, edges of millimetres [1]
constexpr double kSteepest = 0.5;  // sine of a turn below which its chord is at most kChord times as long
constexpr double kChord = 1.04;

constexpr Eigen::Index kBlock = 128;  // vertices: most blocks of so many need nothing
using Block = Eigen::Array<double, Eigen::Dynamic, 1, 0, kBlock, 1>;

Group cosine(const Vectors& area, const Vectors& normal) {
  return area.dot(normal) / area.dot(area).sqrt();
}

Eigen::Vector3d vectorOf(const SelfContactBounds::NodeVectors& x, int vertex) {
  return {x[0][vertex], x[1][vertex], x[2][vertex]};
}

using Components = std::array<Eigen::Map<const Eigen::ArrayXd>, 3>;
Components componentsOf(const SelfContactBounds::NodeVectors& x, std::size_t count) {
  const auto size = static_cast<Eigen::Index>(count);
  return {Eigen::Map<const Eigen::ArrayXd>(x[0], size), Eigen::Map<const Eigen::ArrayXd>(x[1], size),
          Eigen::Map<const Eigen::ArrayXd>(x[2], size)};
}
Components componentsOf(const std::array<std::vector<double>, 3>& x) {
  return componentsOf({x[0].data(), x[1].data(), x[2].data()}, x[0].size());
}

/// Four values per vertex, as a group of triangles reads them.
void pack(const SelfContactBounds::NodeVectors& x, std::vector<float>& packed) {
  for (std::size_t i = 0; 4 * i < packed.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) packed[4 * i + k] = static_cast<float>(x[k][i]);
}

}  // namespace

/// Of a group of triangles: two edges and their product.
struct SelfContactBounds::Area {
  self_contact::Vectors ab, ac, product;
};

SelfContactBounds::SelfContactBounds(const std::vector<std::array<int, 3>>& triangles, std::vector<int> part,
                                     double slack)
    : triangles_(triangles),
      part_(std::move(part)),
      part_moves_(part_.empty() ? 0 : *std::max_element(part_.begin(), part_.end()) + 1),
      slack_(slack),
      centre_(part_.size(), Eigen::Vector3d::Zero()),
      radius_(part_.size(), -1),
      square_(part_.size(), -1),
      cone_(triangles.size()),
      coarse_(triangles.size(), 0),
      start_(4 * part_.size()),
      end_(4 * part_.size()) {
  const std::size_t vertices = part_.size();
  const std::size_t padded = (triangles.size() + kGroup - 1) / kGroup * kGroup;
  for (std::size_t k = 0; k < 3; ++k) {
    middle_[k].assign(vertices, 0);
    checked_[k].assign(vertices, 0);
    normal_[k].assign(padded, 0);
  }
  moved_.reserve(vertices);
  wide_.reserve(vertices);
  turned_.reserve(triangles.size());
  turn_.assign(padded, 0);
  cosine_.assign(padded, 2);
}

void SelfContactBounds::reset() {
  std::fill(square_.begin(), square_.end(), -1.0);
  std::fill(cosine_.begin(), cosine_.end(), 2.0F);
  still_ = holds_ = -1;
  max_radius_ = 0;
}

bool SelfContactBounds::adapt(const NodeVectors& start, const NodeVectors& end) {
  moved_.clear();
  turned_.clear();
  if (holdAll(end)) return true;
  if (start != end)
    for (const int i : wide_)
      if (radius_[i] > kWide * radiusFor((vectorOf(end, i) - vectorOf(start, i)).norm())) square_[i] = -1;
  if (!adaptBalls(start, end)) {
    reset();
    return false;
  }
  if (still_ < 0 || farthest_ > still_ * still_ || (any_wide_cone_ && start != end)) {
    adaptCones(start, end);
    farthest_ = 0;
  }
  holds_ = wide_.empty() && !any_wide_cone_ ? std::min(still_, ball_spare_ - std::sqrt(farthest_)) : -1;
  return true;
}

// One pass over the vertices where hardly anything moves.
bool SelfContactBounds::holdAll(const NodeVectors& end) const {
  if (!(holds_ > 0)) return false;
  const Components x = componentsOf(end, radius_.size()), checked = componentsOf(checked_);
  Block squares;
  for (Eigen::Index first = 0, n = x[0].size(); first < n; first += kBlock) {
    const Eigen::Index count = std::min(kBlock, n - first);
    const auto square = [&](std::size_t k) {
      return (x[k].segment(first, count) - checked[k].segment(first, count)).square();
    };
    squares = square(0) + square(1) + square(2);
    if (!(squares.sum() <= holds_ * holds_)) return false;  // more than enough, and finite
  }
  return true;
}

bool SelfContactBounds::adaptBalls(const NodeVectors& start, const NodeVectors& end) {
  const auto n = static_cast<Eigen::Index>(radius_.size());
  const Components x = componentsOf(end, radius_.size()), middle = componentsOf(middle_),
                   checked = componentsOf(checked_);
  const Eigen::Map<const Eigen::ArrayXd> allowed(square_.data(), n);
  farthest_ = 0;
  double least = std::numeric_limits<double>::infinity();
  Block squares;
  for (Eigen::Index first = 0; first < n; first += kBlock) {
    const Eigen::Index count = std::min(kBlock, n - first);
    const auto square = [&](const Components& from, std::size_t k) {
      return (x[k].segment(first, count) - from[k].segment(first, count)).square();
    };
    squares = square(checked, 0) + square(checked, 1) + square(checked, 2);
    farthest_ = std::max(farthest_, squares.maxCoeff());
    squares = square(middle, 0) + square(middle, 1) + square(middle, 2) - allowed.segment(first, count);
    if (!std::isfinite(squares.sum())) return false;
    least = std::min(least, -squares.maxCoeff());
    if (squares.maxCoeff() <= 0) continue;
    for (Eigen::Index i = 0; i < count; ++i)
      if (squares[i] > 0) moved_.push_back(static_cast<int>(first + i));
  }
  // radius - distance is more than (radius^2 - distance^2) / (2 radius)
  ball_spare_ = moved_.empty() ? least / (2 * max_radius_) : -1;
  if (moved_.empty()) return true;
  addNeighbours(start, end);
  wide_.erase(std::remove_if(wide_.begin(), wide_.end(), [this](int i) { return square_[i] < 0; }), wide_.end());
  for (const int i : moved_) moveBall(i, start, end);
  return true;
}

// Balls of the same parts whose vertices have left the centre behind.
void SelfContactBounds::addNeighbours(const NodeVectors& start, const NodeVectors& end) {
  std::fill(part_moves_.begin(), part_moves_.end(), char{0});
  for (const int i : moved_) part_moves_[part_[i]] = 1;
  for (std::size_t k = 0, count = moved_.size(); k < part_.size(); ++k) {
    const int i = static_cast<int>(k);
    if (part_moves_[part_[k]] == 0 || (count > 0 && std::binary_search(moved_.begin(), moved_.begin() + count, i)))
      continue;
    const Eigen::Vector3d to = vectorOf(end, i);
    if ((to - centre_[k]).dot(to - vectorOf(start, i)) > 0) moved_.push_back(i);
  }
}

// Ahead of the vertex, so that it stays in the ball for long.
void SelfContactBounds::moveBall(int vertex, const NodeVectors& start, const NodeVectors& end) {
  const Eigen::Vector3d from = vectorOf(start, vertex), way = vectorOf(end, vertex) - from;
  const double length = way.norm();
  Eigen::Vector3d& centre = centre_[vertex];
  double& radius = radius_[vertex];
  radius = radiusFor(length);
  centre = from + std::max(0.5, length > 0 ? kLead * radius / length : 0) * way;
  for (int k = 0; k < 3; ++k) middle_[k][vertex] = centre[k];
  square_[vertex] = radius * radius;
  max_radius_ = std::max(max_radius_, radius);
  if (radius > kWide * slack_) wide_.push_back(vertex);
}

// Around a path of a length.
double SelfContactBounds::radiusFor(double length) const {
  return std::max(std::clamp(kSteps * length, slack_, kFarthest * slack_), 0.5 * length + kFastSpare * slack_);
}

SelfContactBounds::Area SelfContactBounds::areaOf(std::size_t first, const std::vector<float>& at) const {
  std::array<Vectors, 3> corner;
  for (std::size_t i = 0; i < kGroup; ++i) {
    const auto& t = triangles_[std::min(first + i, triangles_.size() - 1)];
    for (std::size_t c = 0; c < 3; ++c) {
      const float* p = &at[4 * static_cast<std::size_t>(t[c])];
      corner[c].x[i] = p[0];
      corner[c].y[i] = p[1];
      corner[c].z[i] = p[2];
    }
  }
  Area area{corner[1] - corner[0], corner[2] - corner[0], {}};
  area.product = area.ab.cross(area.ac);
  return area;
}

// The area vector along straight paths is a quadratic Bezier curve, a positive combination of its three control points.
// Afterwards no normal leaves its cone while no vertex moves by more than still_: a triangle of height h turns by less
// than 2 still_ / h.
void SelfContactBounds::adaptCones(const NodeVectors& start, const NodeVectors& end) {
  const bool path = start != end;
  pack(end, end_);
  if (path) pack(start, start_);
  for (std::size_t k = 0; k < 3; ++k) std::copy(end[k], end[k] + radius_.size(), checked_[k].begin());
  any_wide_cone_ = false;
  Group still = Group::Constant(std::numeric_limits<float>::infinity());
  float turned_still = std::numeric_limits<float>::infinity();
  for (std::size_t first = 0; first < triangles_.size(); first += kGroup) {
    const auto load = [first](const std::vector<float>& values) { return Eigen::Map<const Group>(&values[first]); };
    const Vectors normal{load(normal_[0]), load(normal_[1]), load(normal_[2])};
    const Area to = areaOf(first, end_);
    const Group last = cosine(to.product, normal);
    Group least = last;
    if (path) {
      const Area from = areaOf(first, start_);
      least = least.min(cosine(from.product, normal)).min(cosine(from.ab.cross(to.ac) + to.ab.cross(from.ac), normal));
    }
    const Vectors bc = to.ac - to.ab;
    const Group longest = to.ab.dot(to.ab).max(to.ac.dot(to.ac)).max(bc.dot(bc));
    const Group height = (to.product.dot(to.product) / longest).sqrt();
    const Group rest = load(turn_) - (2 - 2 * last + kCosineRounding).max(0).sqrt();
    const Group spare = height * rest.min(static_cast<float>(kSteepest)) / static_cast<float>(2 * kChord);
    const auto held = least >= load(cosine_);
    still = held.select(still.min(spare), still);
    if (held.all()) continue;
    const std::size_t count = std::min(kGroup, triangles_.size() - first);
    for (std::size_t i = 0; i < count; ++i)
      if (!(least[i] >= cosine_[first + i]))
        turned_still = std::min(turned_still, turnCone(static_cast<int>(first + i), start, end) * height[i]);
  }
  still_ = std::max(0.0F, std::min(still.minCoeff(), turned_still));
}

// @returns how far its vertices may move then, in heights
float SelfContactBounds::turnCone(int triangle, const NodeVectors& start, const NodeVectors& end) {
  const auto& t = triangles_[triangle];
  const Eigen::Vector3d a = vectorOf(start, t[0]), d = vectorOf(end, t[0]);
  const Eigen::Vector3d ab = vectorOf(start, t[1]) - a, ac = vectorOf(start, t[2]) - a, de = vectorOf(end, t[1]) - d,
                        df = vectorOf(end, t[2]) - d;
  const Eigen::Vector3d from = ab.cross(ac).normalized(), to = de.cross(df).normalized(),
                        middle = (ab.cross(df) + de.cross(ac)).normalized();
  const Eigen::Vector3d normal = (from + to).normalized();
  const double chord = std::sqrt(
      std::max({(from - normal).squaredNorm(), (to - normal).squaredNorm(), (middle - normal).squaredNorm()}));
  const double usual = coarse_[triangle] != 0 ? kCoarseTurn : kTurn;
  const bool any = !(chord + 0.5 * usual < 1) || !(normal.squaredNorm() > 0.5);
  const double turn = any ? 2 : std::max(usual, chord + 0.5 * usual);
  cone_[triangle] = {normal.cast<float>(), static_cast<float>(turn)};
  for (int k = 0; k < 3; ++k) normal_[k][triangle] = static_cast<float>(normal[k]);
  turn_[triangle] = static_cast<float>(turn);
  cosine_[triangle] = static_cast<float>(1 - 0.5 * turn * turn) + kCosineRounding;
  if (turn > kWideTurn * usual) {
    any_wide_cone_ = true;
    cosine_[triangle] = 2;
  }
  turned_.push_back(triangle);
  const double rest = std::min(kSteepest, turn - (to - normal).norm());
  return any ? std::numeric_limits<float>::max() : static_cast<float>(rest / (2 * kChord));
}

}  // namespace vibe
