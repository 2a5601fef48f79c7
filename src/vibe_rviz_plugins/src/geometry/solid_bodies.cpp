#include "vibe_rviz_plugins/geometry/solid_bodies.hpp"

#include <cmath>

#include "vibe_rviz_plugins/geometry/revolved.hpp"

namespace vibe::rviz_plugins {
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

}  // namespace vibe::rviz_plugins
