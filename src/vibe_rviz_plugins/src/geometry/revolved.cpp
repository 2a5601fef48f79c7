#include "vibe_rviz_plugins/geometry/revolved.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/append_shape.hpp"
#include "vibe_rviz_plugins/geometry/tube.hpp"

namespace vibe::rviz_plugins {
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

}  // namespace vibe::rviz_plugins
