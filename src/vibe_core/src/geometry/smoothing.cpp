#include "geometry/smoothing.hpp"

#include <cmath>

#include "common/elementary.hpp"

namespace vibe {

namespace {

constexpr double kLambda = 0.5;
constexpr double kMu = -0.53;
constexpr int kVolumeIterations = 4;

void stepTowardsNeighbours(SurfaceMesh& mesh, const std::vector<std::vector<int>>& neighbours, double factor) {
  const std::vector<Eigen::Vector3d> old = mesh.vertices;
  for (std::size_t v = 0; v < old.size(); ++v) {
    if (neighbours[v].empty()) continue;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const int k : neighbours[v]) mean += old[k];
    mean /= static_cast<double>(neighbours[v].size());
    mesh.vertices[v] += factor * (mean - old[v]);
  }
}

}  // namespace

void smoothTaubin(SurfaceMesh& mesh, int iterations) {
  const auto neighbours = vertexNeighbours(mesh);
  for (int k = 0; k < iterations; ++k) {
    stepTowardsNeighbours(mesh, neighbours, kLambda);
    stepTowardsNeighbours(mesh, neighbours, kMu);
  }
}

void offsetToVolume(SurfaceMesh& mesh, double volume) {
  for (int k = 0; k < kVolumeIterations; ++k) {
    const double distance = (volume - enclosedVolume(mesh)) / surfaceArea(mesh);
    const auto normals = vertexNormals(mesh);
    for (std::size_t v = 0; v < normals.size(); ++v) mesh.vertices[v] += distance * normals[v];
  }
}

double scaleToVolume(SurfaceMesh& mesh, double volume) {
  const double factor = math::cbrt(volume / enclosedVolume(mesh));
  for (auto& v : mesh.vertices) v *= factor;
  return factor;
}

}  // namespace vibe
