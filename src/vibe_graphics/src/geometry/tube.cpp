#include "vibe_graphics/geometry/tube.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace vibe::graphics {
namespace {

using Eigen::Vector3d;

constexpr double kCoincident = 1e-3;  // of the radius
constexpr double kSharpTurn =
    20 * M_PI / 180;  // sharper joints are swept instead of mitred, because a mitre would stick out
constexpr double kSweepStep = 23 * M_PI / 180;  // of a swept joint, and of a round end
constexpr double kReversal = 1e-6;              // sine below which a turn has no plane

/// A ring of vertices is a ring of directions at right angles to `along`; from the first, the others follow.
struct Frame {
  Vector3d along, first;
};

Vector3d rotated(const Vector3d& v, const Vector3d& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis) * v;
}

double angleBetween(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// The axis about which a turns to b the short way.
Vector3d turnAxis(const Frame& frame, const Vector3d& to) {
  const Vector3d axis = frame.along.cross(to);
  return axis.norm() > kReversal ? Vector3d(axis.normalized()) : frame.first;
}

class TubeBuilder {
 public:
  TubeBuilder(int sides, ColouredShape& shape) : sides_(sides), shape_(shape) {
    for (int k = 0; k < sides; ++k)
      circle_.emplace_back(std::cos(2 * M_PI * k / sides), std::sin(2 * M_PI * k / sides));
  }

  /// Directions of a ring, each taken along `slide` into the plane at right angles to `facing`, which mitres it.
  void mitredRing(const TubePoint& at, const Frame& frame, const Vector3d& facing) {
    ring(
        [&](const Vector3d& out) {
          const Vector3d offset = out - frame.along * (out.dot(facing) / frame.along.dot(facing));
          add(at.place + at.radius * offset, offset.normalized(), at.colour);
        },
        frame);
  }

  /// A circle of a ball around the place: latitude 0 is its equator.
  void circle(const TubePoint& at, const Frame& frame, double latitude) {
    const double outwards = std::cos(latitude), along = std::sin(latitude);
    ring(
        [&](const Vector3d& out) {
          const Vector3d normal = outwards * out + along * frame.along;
          add(at.place + at.radius * normal, normal, at.colour);
        },
        frame);
  }

  void start(const TubePoint& at, const Frame& frame) {
    pole_ = static_cast<std::uint32_t>(shape_.vertices.size());
    add(at.place - at.radius * frame.along, -frame.along, at.colour);
    rings_ = 0;
    const int steps = capSteps();
    for (int k = 1; k <= steps; ++k) circle(at, frame, (k - steps) * M_PI / (2 * steps));
  }

  void finish(const TubePoint& at, const Frame& frame) {
    const int steps = capSteps();
    for (int k = 1; k < steps; ++k) circle(at, frame, k * M_PI / (2 * steps));
    const std::uint32_t last = next() - static_cast<std::uint32_t>(sides_), pole = next();
    add(at.place + at.radius * frame.along, frame.along, at.colour);
    for (int k = 0; k < sides_; ++k) triangle(last + side(k), last + side(k + 1), pole);
  }

 private:
  int capSteps() const { return std::max(2, sides_ / 4); }
  std::uint32_t next() const { return static_cast<std::uint32_t>(shape_.vertices.size()); }
  std::uint32_t side(int k) const { return static_cast<std::uint32_t>(k % sides_); }

  void add(const Vector3d& place, const Vector3d& normal, PackedColour colour) {
    const Eigen::Vector3f p = place.cast<float>(), n = normal.cast<float>();
    shape_.vertices.push_back({{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}});
    shape_.colours.push_back(colour);
  }

  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    shape_.triangles.insert(shape_.triangles.end(), {a, b, c});
  }

  template <class AddVertex>
  void ring(AddVertex addVertex, const Frame& frame) {
    const std::uint32_t first = next(), before = first - static_cast<std::uint32_t>(sides_);
    const Vector3d second = frame.along.cross(frame.first);
    for (const Eigen::Vector2d& on : circle_) addVertex(Vector3d(on.x() * frame.first + on.y() * second));
    for (int k = 0; k < sides_; ++k) {
      if (rings_ == 0) {
        triangle(pole_, first + side(k + 1), first + side(k));
        continue;
      }
      triangle(before + side(k), before + side(k + 1), first + side(k + 1));
      triangle(before + side(k), first + side(k + 1), first + side(k));
    }
    ++rings_;
  }

  int sides_, rings_ = 0;
  std::vector<Eigen::Vector2d> circle_;
  ColouredShape& shape_;
  std::uint32_t pole_ = 0;
};

std::vector<TubePoint> withoutCoincident(const std::vector<TubePoint>& points) {
  std::vector<TubePoint> kept;
  for (const TubePoint& point : points) {
    const bool same = !kept.empty() && (point.place - kept.back().place).norm() <= kCoincident * point.radius;
    if (!same) kept.push_back(point);
  }
  return kept;
}

std::vector<Vector3d> directionsOf(const std::vector<TubePoint>& points) {
  std::vector<Vector3d> directions;
  for (std::size_t k = 1; k < points.size(); ++k)
    directions.push_back((points[k].place - points[k - 1].place).normalized());
  return directions;
}

/// At right angles to the plane of the first turn: it moves with the line, so the tube is the same wherever it lies.
Frame firstFrame(const std::vector<Vector3d>& directions) {
  const Vector3d& along = directions.front();
  for (const Vector3d& other : directions) {
    const Vector3d normal = along.cross(other);
    if (normal.norm() > 1e-3) return {along, normal.normalized()};
  }
  return {along, anyNormal(along)};
}

Frame turned(const Frame& frame, const Vector3d& axis, double angle) {
  return {rotated(frame.along, axis, angle), rotated(frame.first, axis, angle)};
}

/// Goes around the corner at a point; returns the frame behind it.
Frame addJoint(const TubePoint& at, const Frame& before, const Vector3d& to, TubeBuilder& builder) {
  const double angle = angleBetween(before.along, to);
  const Vector3d axis = turnAxis(before, to);
  Frame after = turned(before, axis, angle);
  after.along = to;
  if (angle < kSharpTurn) {
    builder.mitredRing(at, before, (before.along + to).normalized());
    return after;
  }
  const int steps = static_cast<int>(std::ceil(angle / kSweepStep));
  for (int k = 0; k <= steps; ++k) builder.circle(at, turned(before, axis, angle * k / steps), 0);
  return after;
}

}  // namespace

Vector3d anyNormal(const Vector3d& direction) {
  Vector3d::Index min;
  direction.cwiseAbs().minCoeff(&min);
  return direction.cross(Vector3d::Unit(min)).normalized();
}

void appendTube(const std::vector<TubePoint>& points, int sides, ColouredShape& shape) {
  const std::vector<TubePoint> kept = withoutCoincident(points);
  if (kept.empty()) return;
  std::vector<Vector3d> directions = directionsOf(kept);
  if (directions.empty()) directions.push_back(Vector3d::UnitZ());
  Frame frame = firstFrame(directions);
  TubeBuilder builder(std::max(3, sides), shape);
  builder.start(kept.front(), frame);
  for (std::size_t k = 1; k + 1 < kept.size(); ++k) frame = addJoint(kept[k], frame, directions[k], builder);
  if (kept.size() > 1) builder.circle(kept.back(), frame, 0);
  builder.finish(kept.back(), frame);
}

void appendTube(const std::vector<Vector3d>& points, double radius, PackedColour colour, int sides,
                ColouredShape& shape) {
  std::vector<TubePoint> tube;
  tube.reserve(points.size());
  for (const Vector3d& place : points) tube.push_back({place, radius, colour});
  appendTube(tube, sides, shape);
}

void appendBall(const Vector3d& centre, double radius, PackedColour colour, int sides, ColouredShape& shape) {
  appendTube({{centre, radius, colour}}, sides, shape);
}

}  // namespace vibe::graphics
