#include "vibe_graphics/geometry/solid_bodies.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "vibe_graphics/geometry/coloured_shape.hpp"
#include "vibe_graphics/geometry/tube.hpp"

namespace vibe::graphics {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Of the profile at point k: the mean of the normals of the pieces around it. To the right of the way.
Vector2d profileNormal(const std::vector<ProfilePoint>& profile, std::size_t k, bool closed) {
  const std::size_t last = profile.size() - 1;
  Vector2d sum = Vector2d::Zero();
  const auto addPiece = [&](std::size_t from, std::size_t to) {
    const Vector2d way = profile[to] - profile[from];
    if (way.norm() > 0) sum += Vector2d(way.y(), -way.x()).normalized();
  };
  if (k > 0) addPiece(k - 1, k);
  if (k < last) addPiece(k, k + 1);
  if (closed && k == 0) addPiece(last - 1, last);
  if (closed && k == last) addPiece(0, 1);
  return sum.norm() > 0 ? Vector2d(sum.normalized()) : Vector2d::UnitX();
}

/// Unit vectors around an axis, evenly.
std::vector<Vector3d> around(const Vector3d& axis, int sides) {
  const Vector3d first = anyNormal(axis), second = axis.cross(first);
  std::vector<Vector3d> directions;
  for (int k = 0; k < sides; ++k)
    directions.emplace_back(std::cos(2 * M_PI * k / sides) * first + std::sin(2 * M_PI * k / sides) * second);
  return directions;
}

void addCircle(const ProfilePoint& point, const Vector2d& normal, const Vector3d& origin, const Vector3d& axis,
               const std::vector<Vector3d>& directions, PackedColour colour, ColouredShape& shape) {
  for (const Vector3d& out : directions) {
    const Eigen::Vector3f p = (origin + point.x() * axis + point.y() * out).cast<float>();
    const Eigen::Vector3f n = (normal.x() * axis + normal.y() * out).cast<float>();
    shape.vertices.push_back({{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}});
    shape.colours.push_back(colour);
  }
}

}  // namespace

void appendRevolved(const std::vector<ProfilePoint>& profile, const Vector3d& origin, const Vector3d& axis,
                    PackedColour colour, int sides, ColouredShape& shape) {
  if (profile.size() < 2) return;
  sides = std::max(3, sides);
  const std::vector<Vector3d> directions = around(axis, sides);
  const bool closed = (profile.front() - profile.back()).norm() < 1e-12;
  for (std::size_t k = 0; k < profile.size(); ++k) {
    const auto first = static_cast<std::uint32_t>(shape.vertices.size());
    addCircle(profile[k], profileNormal(profile, k, closed), origin, axis, directions, colour, shape);
    if (k > 0)
      joinRows(first - static_cast<std::uint32_t>(sides), first, static_cast<std::uint32_t>(sides), true, shape);
  }
}

void appendRing(const Vector3d& centre, const Vector3d& axis, double radius, double thickness, PackedColour colour,
                int sides, ColouredShape& shape) {
  constexpr int kAround = 8;
  std::vector<ProfilePoint> profile;
  for (int k = 0; k < kAround; ++k) {
    const double angle = 2 * M_PI * k / kAround;
    profile.emplace_back(thickness * std::cos(angle), radius + thickness * std::sin(angle));
  }
  profile.push_back(profile.front());
  appendRevolved(profile, centre, axis, colour, sides, shape);
}

void appendBobbin(const Vector3d& centre, const Vector3d& axis, double length, double rim, PackedColour colour,
                  int sides, ColouredShape& shape) {
  constexpr double kOutline[][2] = {{0.50, 0.0},  {0.50, 0.84}, {0.47, 0.97},  {0.43, 1.0},   {0.36, 1.0},
                                    {0.33, 0.97}, {0.33, 0.66}, {0.0, 0.62},   {-0.33, 0.66}, {-0.33, 0.97},
                                    {-0.36, 1.0}, {-0.43, 1.0}, {-0.47, 0.97}, {-0.50, 0.84}, {-0.50, 0.0}};
  std::vector<ProfilePoint> profile;
  for (const auto& point : kOutline) profile.emplace_back(length * point[0], rim * point[1]);
  appendRevolved(profile, centre, axis, colour, sides, shape);
}

namespace {

constexpr int kSolidSides = 32, kSphereRings = 16;

void appendFace(const Eigen::Isometry3d& pose, const Eigen::Vector3d& size, int axis, double sign, PackedColour colour,
                ColouredShape& shape) {
  const auto first = static_cast<std::uint32_t>(shape.vertices.size());
  const Eigen::Vector3d out = sign * Eigen::Vector3d::Unit(axis);
  const Eigen::Vector3d along = Eigen::Vector3d::Unit((axis + 1) % 3), across = out.cross(along);
  const Eigen::Vector3f normal = (pose.linear() * out).cast<float>();
  for (const auto& [a, b] : {std::pair(-1., -1.), {1., -1.}, {1., 1.}, {-1., 1.}}) {
    const Eigen::Vector3d corner = 0.5 * size.cwiseProduct(out + a * along + b * across);
    const Eigen::Vector3f place = (pose * corner).cast<float>();
    shape.vertices.push_back({{place.x(), place.y(), place.z()}, {normal.x(), normal.y(), normal.z()}});
    shape.colours.push_back(colour);
  }
  for (const std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) shape.triangles.push_back(first + corner);
}

}  // namespace

void appendSphere(const Eigen::Isometry3d& pose, double radius, PackedColour colour, ColouredShape& shape) {
  std::vector<ProfilePoint> profile;
  for (int k = 0; k <= kSphereRings; ++k) {
    const double angle = M_PI * k / kSphereRings;
    profile.emplace_back(radius * std::cos(angle), k % kSphereRings == 0 ? 0 : radius * std::sin(angle));
  }
  appendRevolved(profile, pose.translation(), pose.linear().col(2), colour, kSolidSides, shape);
}

void appendCylinder(const Eigen::Isometry3d& pose, double radius, double length, PackedColour colour,
                    ColouredShape& shape) {
  const double end = 0.5 * length;
  const Eigen::Vector3d axis = pose.linear().col(2);
  // three separate parts keep the edges sharp
  for (const std::vector<ProfilePoint>& profile : {std::vector<ProfilePoint>{{end, 0}, {end, radius}},
                                                   {{end, radius}, {-end, radius}},
                                                   {{-end, radius}, {-end, 0}}})
    appendRevolved(profile, pose.translation(), axis, colour, kSolidSides, shape);
}

void appendBox(const Eigen::Isometry3d& pose, const Eigen::Vector3d& size, PackedColour colour, ColouredShape& shape) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1., 1.}) appendFace(pose, size, axis, sign, colour, shape);
}

}  // namespace vibe::graphics
