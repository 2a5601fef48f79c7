#pragma once
#include <array>
#include <vector>

#include "tool_contact/surface_contacts.hpp"
#include "tool_contact/thin_tool.hpp"

namespace vibe::test::sheet {

using Points = std::array<std::vector<double>, 3>;

constexpr double kThickness = 2e-3;

/// A square sheet of `cells` by `cells` pairs of triangles around the origin, in the plane x = 0.
inline SurfaceMesh sheet(double size, int cells) {
  SurfaceMesh mesh;
  for (int i = 0; i <= cells; ++i)
    for (int j = 0; j <= cells; ++j)
      mesh.vertices.emplace_back(0, size * (static_cast<double>(i) / cells - 0.5),
                                 size * (static_cast<double>(j) / cells - 0.5));
  const auto at = [cells](int i, int j) { return i * (cells + 1) + j; };
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

inline Points pointsOf(const SurfaceMesh& mesh) {
  Points points;
  for (const Eigen::Vector3d& p : mesh.vertices)
    for (int k = 0; k < 3; ++k) points[static_cast<std::size_t>(k)].push_back(p[k]);
  return points;
}

inline SurfacePath pathOf(const Points& from, const Points& to) {
  return {{from[0].data(), from[1].data(), from[2].data()}, {to[0].data(), to[1].data(), to[2].data()}};
}

/// A thin tool before a sheet at rest: the capsule's front is `gap` before the sheet at `place` (y, z).
struct SheetScene {
  explicit SheetScene(double radius, int cells = 6, double length = 0.01)
      : tool(ToolModel::fromUrdf(test::thinToolText(radius, length, 10), "thin")),
        mesh(sheet(0.03, cells)),
        start(pointsOf(mesh)),
        thickness(mesh.vertices.size(), kThickness),
        none(mesh.vertices.size(), 0),
        contacts(tool, mesh, thickness, none) {
    front = tool_front(length, radius);
  }
  /// Link poses that put the front of the capsule at a place, pointing along x.
  std::vector<Eigen::Isometry3d> posesAt(const Eigen::Vector3d& place,
                                         const Eigen::Matrix3d& turn = Eigen::Matrix3d::Identity()) {
    std::vector<Eigen::Isometry3d> poses(static_cast<std::size_t>(tool.linkCount()), Eigen::Isometry3d::Identity());
    for (Eigen::Isometry3d& pose : poses) {
      pose.linear() = turn;
      pose.translation() = place - turn * front;
    }
    return poses;
  }
  static Eigen::Vector3d tool_front(double length, double radius) { return {length + radius, 0, 0}; }

  ToolModel tool;
  SurfaceMesh mesh;
  Points start;
  std::vector<double> thickness;
  std::vector<char> none;
  SurfaceContacts contacts;
  Eigen::Vector3d front;
};

}  // namespace vibe::test::sheet
