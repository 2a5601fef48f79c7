#include "tetrahedra/tetrahedra.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <type_traits>
#include <unordered_map>

#include <Eigen/Dense>

#include "tetrahedra/tetrahedron_energy.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::benchmarks {

namespace {

constexpr int kTetrahedraPerPiece = 2000;  // with fewer, a second thread does not pay off
constexpr int kTetrahedraPieces = 8;

// Derivatives of the position with respect to barycentric coordinates 1, 2, 3, minus that of coordinate 0, at an
// integration point; in columns.
template <int Nodes>
Eigen::Matrix3d restEdges(const std::vector<Eigen::Vector3d>& nodes, const std::array<int, Nodes>& element, int point) {
  const auto node = [&](int a) -> const Eigen::Vector3d& { return nodes[static_cast<std::size_t>(element[a])]; };
  Eigen::Matrix3d out;
  if constexpr (Nodes == 4) {
    for (int i = 0; i < 3; ++i) out.col(i) = node(i + 1) - node(0);
  } else {
    const auto byCoordinate = [&](int i) {
      Eigen::Vector3d sum = -node(i);
      for (int other = 0; other < 4; ++other) {
        const double coordinate = other == point ? kGaussNear : kGaussFar;
        sum += 4 * coordinate * node(kEdgeNode[i][other]);  // for other = i the vertex: 4 L_i - 1
      }
      return sum;
    };
    for (int i = 0; i < 3; ++i) out.col(i) = byCoordinate(i + 1) - byCoordinate(0);
  }
  return out;
}

std::string elementName(std::size_t element) {
  return "tetrahedron " + std::to_string(element) + " (counted from 0)";
}

}  // namespace

template <int Nodes>
TetElements<Nodes>::TetElements(TetMesh<Nodes> mesh) : mesh_(std::move(mesh)) {
  checkIndices();
  for (std::size_t m = 0; m < mesh_.materials.size(); ++m) {
    checkMaterial(mesh_.materials[m], "material " + std::to_string(m) + " of the tetrahedra");
    laws_.emplace_back(mesh_.materials[m]);
  }
  for (const auto& element : mesh_.elements) flat_nodes_.insert(flat_nodes_.end(), element.begin(), element.end());
  measure();
  makeBatches();
}

template <int Nodes>
TetElements<Nodes>::~TetElements() = default;

template <int Nodes>
void TetElements<Nodes>::checkIndices() const {
  const int nodes = nodeCount(), materials = static_cast<int>(mesh_.materials.size());
  if (!mesh_.material.empty() && mesh_.material.size() != mesh_.elements.size())
    throw Error("The mesh has " + std::to_string(mesh_.elements.size()) + " tetrahedra but the materials of " +
                std::to_string(mesh_.material.size()) + "; give one number per tetrahedron or none.");
  for (std::size_t e = 0; e < mesh_.elements.size(); ++e) {
    for (const int node : mesh_.elements[e])
      if (node < 0 || node >= nodes)
        throw Error(elementName(e) + " has node " + std::to_string(node) + ", but the mesh has the nodes 0 to " +
                    std::to_string(nodes - 1) + ": correct the element or add the node.");
    if (materialOf(e) < 0 || materialOf(e) >= materials)
      throw Error(elementName(e) + " is of material " + std::to_string(materialOf(e)) + ", but there are " +
                  std::to_string(materials) + " materials: correct the number or add the material.");
  }
}

template <int Nodes>
void TetElements<Nodes>::measure() {
  rest_.reserve(mesh_.elements.size() * kPoints * kRows);
  for (std::size_t e = 0; e < mesh_.elements.size(); ++e)
    for (int point = 0; point < kPoints; ++point) {
      const Eigen::Matrix3d edges = restEdges<Nodes>(mesh_.nodes, mesh_.elements[e], point);
      const double volume = edges.determinant() / 6;
      const Eigen::Matrix3d gradients = edges.inverse();
      if (!(volume > 0) || !gradients.allFinite())
        throw Error(elementName(e) + " has no positive volume at rest (" + std::to_string(volume * 1e9) +
                    " mm^3): repair the mesh, or swap two of its vertices where it is turned inside out.");
      for (int i = 0; i < 3; ++i)
        for (int c = 0; c < 3; ++c) rest_.push_back(gradients(i, c));
      rest_.push_back(volume / kPoints);
    }
}

// Equal to single precision; the points of an element then share their rows.
template <int Nodes>
bool TetElements<Nodes>::straight() const {
  constexpr double kTolerance = 1e-7;
  for (std::size_t e = 0; e < mesh_.elements.size(); ++e) {
    const double* first = rest(e, 0);
    const double size =
        std::abs(*std::max_element(first, first + 9, [](double a, double b) { return std::abs(a) < std::abs(b); }));
    for (int point = 1; point < kPoints; ++point)
      for (int row = 0; row < kRows; ++row)
        if (std::abs(rest(e, point)[row] - first[row]) > kTolerance * (row == 9 ? first[9] : size)) return false;
  }
  return true;
}

template <int Nodes>
void TetElements<Nodes>::makeBatches() {
  straight_ = straight();
  std::vector<std::vector<int>> of_material(mesh_.materials.size());
  for (std::size_t e = 0; e < mesh_.elements.size(); ++e)
    of_material[static_cast<std::size_t>(materialOf(e))].push_back(static_cast<int>(e));
  for (std::size_t m = 0; m < of_material.size(); ++m) {
    const int first = static_cast<int>(batches_.size());
    addBatches(of_material[m]);
    const int last = static_cast<int>(batches_.size());
    if (last > first) runs_.push_back({first, last, static_cast<int>(m)});
  }
  piece_count_ = static_cast<int>(mesh_.elements.size()) > kTetrahedraPerPiece ? kTetrahedraPieces : 1;
}

// Elements adjacent in the mesh are adjacent in its order. They have the same place in successive batches.
template <int Nodes>
void TetElements<Nodes>::addBatches(const std::vector<int>& elements) {
  const int count = static_cast<int>(elements.size());
  const int batches = (count + kBatch - 1) / kBatch;
  for (int window = 0; window < batches; window += kWindow) {
    const int length = std::min(kWindow, batches - window);
    for (int step = 0; step < length; ++step) {
      Batch& batch = batches_.emplace_back();
      for (int place = 0; place < kBatch; ++place) {
        const int slot = window * kBatch + place * length + step;
        batch[static_cast<std::size_t>(place)] = slot < count ? elements[static_cast<std::size_t>(slot)] : -1;
      }
    }
  }
}

template <int Nodes>
template <class Real>
Real TetElements<Nodes>::elementEnergy(std::size_t element, const Real (&u)[Nodes][3], Real (&force)[Nodes][3]) const {
  const bool shared = std::is_same_v<Real, float> && straight_;
  const auto rows = [&](int point, int row) { return static_cast<Real>(rest(element, shared ? 0 : point)[row]); };
  const MaterialEnergy& law = laws_[static_cast<std::size_t>(materialOf(element))];
  return benchmarks::elementEnergy<Nodes>(law, u, rows, force);
}

template <int Nodes>
void TetElements<Nodes>::evaluateBatch(const Batch& batch, const float* displacement4, float* gradient4,
                                       std::array<double, kBatch>& energy) const {
  float force[kBatch][Nodes][3];
  for (std::size_t k = 0; k < kBatch; ++k) {
    if (batch[k] < 0) continue;
    const auto e = static_cast<std::size_t>(batch[k]);
    float u[Nodes][3];
    for (int a = 0; a < Nodes; ++a)
      for (int r = 0; r < 3; ++r) u[a][r] = displacement4[4 * mesh_.elements[e][a] + r];
    energy[k] += static_cast<double>(elementEnergy(e, u, force[k]));
  }
  for (int a = 0; a < Nodes; ++a)
    for (std::size_t k = 0; k < kBatch; ++k)
      for (int r = 0; batch[k] >= 0 && r < 3; ++r)
        gradient4[4 * mesh_.elements[static_cast<std::size_t>(batch[k])][a] + r] += force[k][a][r];
}

template <int Nodes>
double TetElements<Nodes>::evaluate(int piece, const float* displacement4, float* gradient4) const {
  const auto bound = [&](int p) {
    return static_cast<int>(static_cast<std::int64_t>(batches_.size()) * p / piece_count_);
  };
  double energy = 0;
  for (const Run& run : runs_) {
    const int begin = std::max(bound(piece), run.first), end = std::min(bound(piece + 1), run.last);
    std::array<double, kBatch> sum{};
    for (int b = begin; b < end; ++b)
      evaluateBatch(batches_[static_cast<std::size_t>(b)], displacement4, gradient4, sum);
    energy += ((sum[0] + sum[4]) + (sum[1] + sum[5])) + ((sum[2] + sum[6]) + (sum[3] + sum[7]));
  }
  return energy;
}

template <int Nodes>
double TetElements<Nodes>::evaluate(const double* displacement, double* gradient) const {
  std::fill(gradient, gradient + 3 * mesh_.nodes.size(), 0.0);
  double energy = 0;
  for (std::size_t e = 0; e < mesh_.elements.size(); ++e) {
    const auto& nodes = mesh_.elements[e];
    double u[Nodes][3], force[Nodes][3];
    for (int a = 0; a < Nodes; ++a)
      for (int r = 0; r < 3; ++r) u[a][r] = displacement[3 * nodes[a] + r];
    energy += elementEnergy(e, u, force);
    for (int a = 0; a < Nodes; ++a)
      for (int r = 0; r < 3; ++r) gradient[3 * nodes[a] + r] += force[a][r];
  }
  return energy;
}

template <int Nodes>
std::vector<std::pair<const std::vector<int>*, int>> TetElements<Nodes>::nodeGroups() const {
  return {{&flat_nodes_, Nodes}};
}

template <int Nodes>
double TetElements<Nodes>::volumeOf(std::size_t element) const {
  double sum = 0;
  for (int point = 0; point < kPoints; ++point) sum += rest(element, point)[9];
  return sum;
}

template <int Nodes>
double TetElements<Nodes>::volume() const {
  double sum = 0;
  for (std::size_t e = 0; e < mesh_.elements.size(); ++e) sum += volumeOf(e);
  return sum;
}

template <int Nodes>
std::vector<double> TetElements<Nodes>::lumpedMass(double density) const {
  std::vector<double> mass(mesh_.nodes.size(), 0.0);
  for (std::size_t e = 0; e < mesh_.elements.size(); ++e)
    for (int a = 0; a < Nodes; ++a) {
      const double share = Nodes == 4 ? 1.0 / 4 : a < 4 ? 1.0 / 36 : 4.0 / 27;
      mass[static_cast<std::size_t>(mesh_.elements[e][a])] += share * density * volumeOf(e);
    }
  return mass;
}

template class TetElements<4>;
template class TetElements<10>;

QuadraticMesh quadraticMesh(const TetMesh<4>& linear) {
  constexpr int kEdges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  QuadraticMesh out;
  out.mesh.nodes = linear.nodes;
  out.mesh.materials = linear.materials;
  out.mesh.material = linear.material;
  std::unordered_map<std::uint64_t, int> number_of;
  const auto midNode = [&](int a, int b) {
    const auto [low, high] = std::minmax(a, b);
    const std::uint64_t key = static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint32_t>(high);
    const auto [entry, is_new] = number_of.try_emplace(key, static_cast<int>(out.mesh.nodes.size()));
    if (is_new) {
      const auto position = [&](int v) { return linear.nodes[static_cast<std::size_t>(v)]; };
      out.mesh.nodes.push_back((position(low) + position(high)) / 2);
      out.edges.push_back({low, high});
    }
    return entry->second;
  };
  for (std::size_t e = 0; e < linear.elements.size(); ++e) {
    const auto& vertices = linear.elements[e];
    for (const int v : vertices)
      if (v < 0 || static_cast<std::size_t>(v) >= linear.nodes.size())
        throw Error("tetrahedron " + std::to_string(e) + " (counted from 0) has node " + std::to_string(v) +
                    ", but the mesh has " + std::to_string(linear.nodes.size()) +
                    " nodes: correct the element or add the node.");
    std::array<int, 10> nodes;
    std::copy(vertices.begin(), vertices.end(), nodes.begin());
    for (std::size_t k = 0; k < 6; ++k)
      nodes[4 + k] =
          midNode(vertices[static_cast<std::size_t>(kEdges[k][0])], vertices[static_cast<std::size_t>(kEdges[k][1])]);
    out.mesh.elements.push_back(nodes);
  }
  return out;
}

}  // namespace vibe::benchmarks
