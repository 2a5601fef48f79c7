#include "tissue/tetrahedra.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string>

#include "tissue/tetrahedra_point.hpp"
#include "vibe_core/common/error.hpp"

namespace vibe {
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
TetElements<Nodes>::TetElements(TetMesh<Nodes> mesh, TetKernel kernel) : mesh_(std::move(mesh)), kernel_(kernel) {
  checkIndices();
  for (std::size_t m = 0; m < mesh_.materials.size(); ++m) {
    checkMaterial(mesh_.materials[m], "material " + std::to_string(m) + " of the tetrahedra");
    constants_.push_back(lawConstants(mesh_.materials[m]));
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
  const bool shared = straight();
  point_stride_ = shared ? 0 : kRows;
  batch_stride_ = shared ? kRows : kRows * kPoints;
  std::vector<std::vector<int>> of_material(mesh_.materials.size());
  for (std::size_t e = 0; e < mesh_.elements.size(); ++e)
    of_material[static_cast<std::size_t>(materialOf(e))].push_back(static_cast<int>(e));
  for (std::size_t m = 0; m < of_material.size(); ++m) {
    const std::vector<int>& elements = of_material[m];
    const int first = batch_count_;
    addBatches(elements);
    if (batch_count_ > first) runs_.push_back({first, batch_count_, static_cast<int>(m)});
  }
  piece_count_ = static_cast<int>(mesh_.elements.size()) > kTetrahedraPerPiece ? kTetrahedraPieces : 1;
}

// Elements adjacent in the mesh are adjacent in its order. They are placed in the same lane of successive batches, not
// in the lanes of one batch: adding to a node that the previous lane has just written would stall.
template <int Nodes>
void TetElements<Nodes>::addBatches(const std::vector<int>& elements) {
  const int count = static_cast<int>(elements.size());
  const int batches = (count + kTetLanes - 1) / kTetLanes;
  for (int window = 0; window < batches; window += kWindow) {
    const int length = std::min(kWindow, batches - window);
    for (int step = 0; step < length; ++step) {
      std::array<int, kTetLanes> lanes;
      for (int lane = 0; lane < kTetLanes; ++lane) {
        const int slot = window * kTetLanes + lane * length + step;
        lanes[static_cast<std::size_t>(lane)] = slot < count ? elements[static_cast<std::size_t>(slot)] : -1;
      }
      addBatch(lanes);
    }
  }
}

template <int Nodes>
void TetElements<Nodes>::addBatch(const std::array<int, kTetLanes>& elements) {
  const int filler = *std::max_element(elements.begin(), elements.end());  // -1: the lane is empty
  const int points = batch_stride_ / kRows;
  const std::size_t node = batch_node_.size(), row = batch_rest_.size();
  batch_node_.resize(node + Nodes);
  batch_rest_.resize(row + static_cast<std::size_t>(batch_stride_));
  for (std::size_t lane = 0; lane < kTetLanes; ++lane) {
    const bool empty = elements[lane] < 0;
    const std::size_t e = static_cast<std::size_t>(empty ? filler : elements[lane]);
    for (std::size_t a = 0; a < Nodes; ++a)
      batch_node_[node + a].lane[lane] = 4 * static_cast<std::uint32_t>(mesh_.elements[e][a]);
    // an empty lane has neither deformation nor energy
    for (int k = 0; k < points * kRows; ++k)
      batch_rest_[row + static_cast<std::size_t>(k)].lane[lane] = empty ? 0 : static_cast<float>(rest(e, 0)[k]);
  }
  ++batch_count_;
}

template <int Nodes>
double TetElements<Nodes>::evaluate(int piece, const float* displacement4, float* gradient4) const {
  const int first = static_cast<int>(static_cast<std::int64_t>(batch_count_) * piece / piece_count_);
  const int last = static_cast<int>(static_cast<std::int64_t>(batch_count_) * (piece + 1) / piece_count_);
  const TetSweepFunction sweep = Nodes == 4 ? kernel_.linear : kernel_.quadratic;
  double energy = 0;
  for (const Run& run : runs_) {
    const int begin = std::max(first, run.first), end = std::min(last, run.last);
    if (begin >= end) continue;
    const auto material = static_cast<std::size_t>(run.material);
    energy += sweep({batch_node_.data(), batch_rest_.data(), batch_stride_, point_stride_, begin, end,
                     mesh_.materials[material].law, &constants_[material], displacement4, gradient4});
  }
  return energy;
}

template <int Nodes>
double TetElements<Nodes>::evaluate(const double* displacement, double* gradient) const {
  std::fill(gradient, gradient + 3 * mesh_.nodes.size(), 0.0);
  double energy = 0;
  for (std::size_t e = 0; e < mesh_.elements.size(); ++e) {
    const auto& nodes = mesh_.elements[e];
    const auto material = static_cast<std::size_t>(materialOf(e));
    double u[Nodes][3], force[Nodes][3];
    for (int a = 0; a < Nodes; ++a)
      for (int r = 0; r < 3; ++r) u[a][r] = displacement[3 * nodes[a] + r];
    const auto rows = [this, e](int point, int row) { return rest(e, point)[row]; };
    energy += withLaw(mesh_.materials[material].law, [&](auto tag) {
      return elementEnergy<Nodes, decltype(tag)::value>(LawTerms<double>(constants_[material]), u, rows, force);
    });
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

}  // namespace vibe
