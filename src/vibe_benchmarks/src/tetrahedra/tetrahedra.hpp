#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "vibe_core/tissue/elastic_elements.hpp"
#include "vibe_core/tissue/material_registry.hpp"

namespace vibe::benchmarks {

/// A solid of tetrahedra at rest. Nodes 4: linear. Nodes 10: quadratic, straight or curved; the vertices first, then
/// the nodes on the edges 01 12 20 03 13 23 (the order of VTK and of most finite element codes). Seen from vertex 3,
/// the triangle 0 1 2 is counter-clockwise.
template <int Nodes>
struct TetMesh {
  static_assert(Nodes == 4 || Nodes == 10, "tetrahedra have 4 or 10 nodes here");
  std::vector<Eigen::Vector3d> nodes;            ///< [m]
  std::vector<std::array<int, Nodes>> elements;  ///< node numbers
  std::vector<Material> materials;
  std::vector<int> material;  ///< per element, index into `materials`; empty: all of the first
};

/// The same solid with an additional node at the midpoint of every edge, appended after the vertices.
struct QuadraticMesh {
  TetMesh<10> mesh;
  std::vector<std::array<int, 2>> edges;  ///< the two vertices of node (vertices + k), ascending; by first use
};
QuadraticMesh quadraticMesh(const TetMesh<4>& linear);

/// Hyperelastic tetrahedra: linear with one integration point, quadratic with four (exact for polynomials of degree 2).
/// Quadratic elements bend and are nearly incompressible without locking; linear elements lock in both cases.
///
/// The displacement gradient H = F - 1 is used, never F, so single precision resolves a strain of 1e-7. The elements of
/// a material are cut into batches of kBatch, whose forces are added node by node, as a kernel for kBatch elements at
/// once adds them: results stay comparable to the bit with those published.
template <int Nodes>
class TetElements : public ElasticElements {
 public:
  static constexpr int kPoints = Nodes == 4 ? 1 : 4;

  /// @throws Error with the number of an element whose volume is not positive (at an integration point), or whose node
  ///         or material is out of range; as checkMaterial for the materials
  explicit TetElements(TetMesh<Nodes> mesh);

  ~TetElements() override;

  int nodeCount() const override { return static_cast<int>(mesh_.nodes.size()); }
  int pieceCount() const override { return piece_count_; }
  double evaluate(int piece, const float* displacement4, float* gradient4) const override;
  double evaluate(const double* displacement, double* gradient) const override;
  std::vector<std::pair<const std::vector<int>*, int>> nodeGroups() const override;
  /// The tangent of each integration point from its eigenvalues, which laws of I and J have in closed form, with
  /// negative ones replaced by 0 (Smith, de Goes, Kim 2019, "Analytic eigensystems for isotropic distortion energies").
  void addStiffness(const double* displacement, BlockMatrix& stiffness) const override;
  /// Linear: a quarter of the element mass each. Quadratic: 1/36 for a vertex and 4/27 for an edge, the diagonal of the
  /// consistent mass of a straight element scaled to its mass (Hinton, Rock, Zienkiewicz 1976).
  std::vector<double> lumpedMass(double density) const override;
  /// Root mean square of the stretch over all directions, averaged over the volume around the node, minus 1.
  void strain(const double* displacement, float* out) const override;

  const TetMesh<Nodes>& mesh() const { return mesh_; }
  double volume() const;  ///< at rest [m^3]

 private:
  struct Run {  // batches of one material
    int first, last, material;
  };
  // Per element and point: the gradients with respect to x, y, z of the barycentric coordinates 1, 2, 3 [1/m], then the
  // volume of the point [m^3].
  static constexpr int kRows = 10;
  static constexpr int kBatch = 8;
  static constexpr int kWindow = 16;      // batches that share a contiguous piece of the mesh
  using Batch = std::array<int, kBatch>;  // elements; -1: the place is empty

  void measure();
  void checkIndices() const;
  bool straight() const;
  void makeBatches();
  void addBatches(const std::vector<int>& elements);
  template <class Real>
  Real elementEnergy(std::size_t element, const Real (&u)[Nodes][3], Real (&force)[Nodes][3]) const;
  void evaluateBatch(const Batch& batch, const float* displacement4, float* gradient4,
                     std::array<double, kBatch>& energy) const;
  double volumeOf(std::size_t element) const;
  const double* rest(std::size_t element, int point) const {
    return rest_.data() + (element * kPoints + point) * kRows;
  }
  int materialOf(std::size_t element) const { return mesh_.material.empty() ? 0 : mesh_.material[element]; }

  TetMesh<Nodes> mesh_;
  std::vector<MaterialEnergy> laws_;  // per material
  std::vector<double> rest_;          // (elements * points * rows)
  bool straight_ = true;              // the points of an element share their rows in single precision
  std::vector<int> flat_nodes_;       // of the elements in sequence
  int piece_count_ = 1;
  std::vector<Run> runs_;
  std::vector<Batch> batches_;
};

extern template class TetElements<4>;
extern template class TetElements<10>;

}  // namespace vibe::benchmarks
