#include "vibe_core/geometry/surface_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace vibe {

namespace {

/// Normal of a triangle with the length of twice its area.
Eigen::Vector3d doubledAreaVector(const SurfaceMesh& mesh, const std::array<int, 3>& triangle) {
  const Eigen::Vector3d& a = mesh.vertices[triangle[0]];
  return (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a);
}

}  // namespace

double enclosedVolume(const SurfaceMesh& mesh) {
  if (mesh.vertices.empty()) return 0.0;
  // relative to a vertex of the mesh: far from the origin the tetrahedra would be large and cancel badly
  const Eigen::Vector3d origin = mesh.vertices.front();
  double sum = 0.0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]] - origin;
    const Eigen::Vector3d b = mesh.vertices[t[1]] - origin;
    const Eigen::Vector3d c = mesh.vertices[t[2]] - origin;
    sum += a.dot(b.cross(c));
  }
  return sum / 6.0;
}

double surfaceArea(const SurfaceMesh& mesh) {
  double sum = 0.0;
  for (const auto& t : mesh.triangles) sum += doubledAreaVector(mesh, t).norm();
  return sum / 2.0;
}

std::vector<double> vertexAreas(const SurfaceMesh& mesh) {
  std::vector<double> areas(mesh.vertices.size(), 0.0);
  for (const auto& t : mesh.triangles) {
    const double third = doubledAreaVector(mesh, t).norm() / 6.0;
    for (const int v : t) areas[v] += third;
  }
  return areas;
}

std::vector<Eigen::Vector3d> vertexNormals(const SurfaceMesh& mesh) {
  std::vector<Eigen::Vector3d> normals(mesh.vertices.size(), Eigen::Vector3d::Zero());
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d n = doubledAreaVector(mesh, t);
    for (const int v : t) normals[v] += n;
  }
  for (auto& n : normals) {
    const double length = n.norm();
    if (length > 0.0) n /= length;
  }
  return normals;
}

std::vector<std::vector<int>> vertexNeighbours(const SurfaceMesh& mesh) {
  std::vector<std::vector<int>> neighbours(mesh.vertices.size());
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      neighbours[t[k]].push_back(t[(k + 1) % 3]);
      neighbours[t[k]].push_back(t[(k + 2) % 3]);
    }
  }
  for (auto& list : neighbours) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return neighbours;
}

}  // namespace vibe
