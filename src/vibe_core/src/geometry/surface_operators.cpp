#include "geometry/surface_operators.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>

#include "arithmetic/elementary.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

using Matrix = Eigen::SparseMatrix<double>;

Eigen::VectorXd solve(const Matrix& matrix, const Eigen::VectorXd& right) {
  const Eigen::SimplicialLDLT<Matrix> factor(matrix);
  Eigen::VectorXd x = factor.solve(right);
  if (factor.info() != Eigen::Success || !x.allFinite()) {
    throw Error("the surface has triangles without area or unconnected parts; remesh it before it is labelled");
  }
  return x;
}

std::vector<double> toVector(const Eigen::VectorXd& x) {
  return {x.data(), x.data() + x.size()};
}

}  // namespace

Matrix cotangentStiffness(const SurfaceMesh& mesh) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(mesh.triangles.size() * 12);
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const int a = t[(k + 1) % 3], b = t[(k + 2) % 3];
      const Eigen::Vector3d u = mesh.vertices[a] - mesh.vertices[t[k]];
      const Eigen::Vector3d v = mesh.vertices[b] - mesh.vertices[t[k]];
      const double weight = 0.5 * u.dot(v) / u.cross(v).norm();
      entries.emplace_back(a, b, -weight);
      entries.emplace_back(b, a, -weight);
      entries.emplace_back(a, a, weight);
      entries.emplace_back(b, b, weight);
    }
  }
  const auto n = static_cast<Eigen::Index>(mesh.vertices.size());
  Matrix matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

std::vector<double> harmonicField(const SurfaceMesh& mesh, const std::vector<int>& zeros,
                                  const std::vector<int>& ones) {
  Matrix matrix = cotangentStiffness(mesh);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(matrix.rows());
  std::vector<bool> fixed(mesh.vertices.size(), false);
  for (const int v : zeros) fixed[v] = true;
  for (const int v : ones) {
    fixed[v] = true;
    right[v] = 1.0;
  }
  // move fixed values to the right-hand side; replace rows and columns of fixed vertices by those of the identity
  const Eigen::VectorXd known = right;
  for (int column = 0; column < matrix.outerSize(); ++column) {
    for (Matrix::InnerIterator entry(matrix, column); entry; ++entry) {
      const bool row_fixed = fixed[entry.row()], column_fixed = fixed[entry.col()];
      if (!row_fixed && column_fixed) right[entry.row()] -= entry.value() * known[entry.col()];
      if (row_fixed || column_fixed) entry.valueRef() = entry.row() == entry.col() ? 1.0 : 0.0;
    }
  }
  return toVector(solve(matrix, right));
}

std::vector<double> diffuse(const SurfaceMesh& mesh, const std::vector<double>& values, double width) {
  const std::vector<double> areas = vertexAreas(mesh);
  const auto n = static_cast<Eigen::Index>(values.size());
  const Eigen::VectorXd mass = Eigen::Map<const Eigen::VectorXd>(areas.data(), n);
  // one implicit step of the heat equation: time width^2 / 2
  Matrix matrix = cotangentStiffness(mesh) * (0.5 * width * width);
  matrix += Matrix(mass.asDiagonal());
  return toVector(solve(matrix, mass.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(values.data(), n))));
}

std::vector<double> edgeDistances(const SurfaceMesh& mesh, const std::vector<int>& seeds) {
  const auto neighbours = vertexNeighbours(mesh);
  std::vector<double> distance(mesh.vertices.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for (const int v : seeds) {
    distance[v] = 0.0;
    open.emplace(0.0, v);
  }
  while (!open.empty()) {
    const auto [d, v] = open.top();
    open.pop();
    if (d > distance[v]) continue;
    for (const int next : neighbours[v]) {
      const double way = d + (mesh.vertices[next] - mesh.vertices[v]).norm();
      if (way < distance[next]) {
        distance[next] = way;
        open.emplace(way, next);
      }
    }
  }
  return distance;
}

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

namespace {
// relative to the first vertex: this does not change the sums over a closed surface and reduces round-off
Eigen::Vector3d corner(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z,
                       int i) {
  return {x[i] - x[0], y[i] - y[0], z[i] - z[0]};
}
}  // namespace

double lumenVolume(const SurfaceMesh& surface, const std::vector<double>& x, const std::vector<double>& y,
                   const std::vector<double>& z) {
  double six_volumes = 0;
  for (const auto& t : surface.triangles)
    six_volumes += corner(x, y, z, t[0]).dot(corner(x, y, z, t[1]).cross(corner(x, y, z, t[2])));
  return six_volumes / 6;
}

}  // namespace vibe
