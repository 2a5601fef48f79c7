#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "vibe_core/tissue/elastic_elements.hpp"
#include "vibe_core/tissue/material_registry.hpp"

namespace vibe {

struct BatchOffsets;
struct BatchReals;
struct LawConstants;
struct ShellKernel;
struct ShellPart;
struct ShellSweep;

/// Up to two families of fibres in the plane of a wall, which resist only tension. Each adds, per volume, modulus / (2
/// stiffening) (exp(stiffening (I - 1)^2) - 1) where the squared stretch I of the fibre is above 1: Holzapfel, Gasser,
/// Ogden 2000, "A new constitutive framework for arterial wall mechanics", without dispersion. Fibres do not contribute
/// to bending.
struct ShellFibres {
  double stiffening = 1;        ///< above 0 (ratio)
  std::vector<double> modulus;  ///< per triangle [Pa]; empty: no fibres
  std::vector<std::array<Eigen::Vector3d, 2>>
      direction;  ///< per triangle, projected onto its plane; 0: the family is absent; unit vector
};

/// A stress that stays as it is, beside that of the law.
struct ConstantStress {
  const float* stress;  ///< (ShellElements::stressCount()) [N/m], [N]; null: none
  double work = 0;      ///< out, added to: the sum of stress times strain, see ShellElements::stress() [J]
};

/// A thin wall at rest, described by its middle surface.
struct ShellMesh {
  std::vector<Eigen::Vector3d> nodes;         ///< [m]
  std::vector<std::array<int, 3>> triangles;  ///< node numbers, counter-clockwise seen from outside
  std::vector<double> thickness;              ///< per triangle [m]
  std::vector<Material> materials;            ///< different ones of the wall, at least one
  std::vector<int> material;                  ///< per triangle, index into `materials`; empty: all of the first
  ShellFibres fibres;                         ///< by default none
  /// Per triangle the direction in which its muscle shortens, projected onto its plane; 0: it has no muscle, and so
  /// has a triangle without three neighbours; empty: the wall has none; unit vector.
  std::vector<Eigen::Vector3d> muscle;
  std::vector<char> fixed;                 ///< per node, nonzero: held; empty: none is held
  std::vector<std::array<int, 2>> hinged;  ///< edges that bend freely although they have two triangles or are fixed
};

/// A thin wall with membrane and bending stiffness: the rotation-free triangles of Flores & Onate 2005, "Improvements
/// in the membrane behaviour of the three node rotation-free BST shell triangle using an assumed strain approach"
/// (EBST). The surface over a triangle is the quadratic one through its nodes 1 2 3 and the apexes of its neighbours: 4
/// beyond the side 2 3, 5 beyond 3 1 and 6 beyond 1 2. The membrane strain follows from its metric at the midpoints of
/// the three sides, in plane stress of any law. The bending strain follows from its curvature at the centroid: the
/// energy, integrated across the wall, to second order in the distance from the middle. The bending stiffness is the
/// tangent of the neo-Hookean law (for any law of the membrane) at the metric of the centroid: E t^3 / (12 (1 - nu^2))
/// at rest, much larger where the wall is compressed along the bend. Distances across the wall are those at rest: with
/// those of the thinned wall the reference pull of a plate is 7 % too soft.
///
/// A side without a neighbour bends freely. A side with two fixed nodes is clamped: its tangent plane is preserved. So
/// is a side of a triangle whose nodes are all fixed, which takes no part in the strain of its neighbour: strain and
/// curvature jump there, and a patch across would take half of the curvature.
/// Muscle contracts by active strain (Rodriguez, Hoger, McCulloch 1994, doi 10.1016/0021-9290(94)90021-3): along its
/// direction the wall at rest is shorter by 1 / (1 + contraction) and as much thicker, and its membrane energy is that
/// of the deformation from there. The contraction of a triangle is the mean of its nodes' fourth numbers. Bending does
/// not see it.
/// Energy and force stay finite if the wall degenerates to a line or a point, or folds over. Memory: the triangles of a
/// material are cut into batches for the kernel, those with three neighbours first.
class ShellElements : public ElasticElements {
 public:
  /// @param origin  reference point of volumes, near the centre of the organ for precision [m]
  /// @throws Error with the number of a triangle that has no area or thickness, has fibres out of range, has a node or
  ///         material out of range, shares a side with two others, is oriented opposite to its neighbour, or lies
  ///         folded upon it; for a hinged side that does not exist; as checkMaterial for the materials
  explicit ShellElements(ShellMesh mesh, const Eigen::Vector3d& origin = Eigen::Vector3d::Zero());
  /// With a certain kernel, for tests; otherwise it is that of the arithmetic and the instruction set in use.
  ShellElements(ShellMesh mesh, const Eigen::Vector3d& origin, const ShellKernel& kernel);
  ~ShellElements() override;

  int nodeCount() const override { return static_cast<int>(mesh_.nodes.size()); }
  int pieceCount() const override { return piece_count_; }
  double evaluate(int piece, const float* displacement4, float* gradient4) const override;
  double evaluate(const double* displacement, double* gradient) const override {
    return evaluate(displacement, nullptr, gradient);
  }
  /// The same with contracted muscle. @param contraction  per node, 0 or more (ratio); null: 0
  double evaluate(const double* displacement, const float* contraction, double* gradient) const;
  /// By how much the energy grows while nothing moves and the contraction of the muscle changes [J].
  /// @param contraction  per node, afterwards (ratio)
  double muscleWork(const float* displacement4, const float* contraction) const;

  /// Numbers of stress(): per triangle the stress at the three sides, as components along material vectors times the
  /// volume [N/m], and the moments [N], in the order of the kernel's batches. Rigid motions do not change them.
  std::size_t stressCount() const;
  /// Stress and moments as the law gives them, with fibres.
  /// @param out     (stressCount())
  /// @param strain  (stressCount()) by number the strain with which it works: the sum of their products is
  ///                stressWork() [m^2], [m]; null: not wanted
  /// @returns the energy [J]
  double stress(const float* displacement4, float* out, float* strain = nullptr) const;
  /// The work that stresses and moments which stay as they are do from rest to the displacements [J]; adds its gradient
  /// [N], minus which is the force on the wall. With those of the law here it is the elastic one, but for how the
  /// bending stiffness depends on the stretch.
  double stressWork(const float* stress, const float* displacement4, float* gradient4) const;

  /// Like evaluate, and also adds the piece's share of the volume [m^3] enclosed by the surface, and a third of each
  /// triangle's area vector to its nodes [m^2]. The latter is the force of a pressure of 1 Pa and, for a closed
  /// surface, the gradient of the volume.
  /// @param volume_gradient4  null: volumes are not wanted
  /// @param beside            the gradient of its work is added as well, as in stressWork(); null: none
  double evaluate(int piece, const float* displacement4, float* gradient4, float* volume_gradient4, double& volume,
                  ConstantStress* beside = nullptr) const;
  /// The pieces after the first of `count` shares, in as many parts less one. The first share adds to the vectors of
  /// all nodes. Empty where there are fewer pieces, and with fibres, which add to a node once more.
  std::vector<ShellPart> partsOf(int count) const;
  /// Like evaluate, with vectors of a part.
  double evaluate(const ShellPart& part, int piece, const float* displacement4, float* gradient4,
                  float* volume_gradient4, double& volume, ConstantStress* beside = nullptr) const;
  /// The volume and its gradient, as above, in double precision; interleaved (3 * nodeCount), overwritten.
  double volume(const double* displacement, double* gradient) const;

  /// Groups of 6: the nodes of a triangle and the apexes of its neighbours, -1 where there is none.
  std::vector<std::pair<const std::vector<int>*, int>> nodeGroups() const override;
  /// Membrane: the tangent of plane stress without its negative eigenvalues, and the stress without its negative
  /// principal values; fibres exactly. Bending: Gauss-Newton, without the derivative of the moment arm.
  void addStiffness(const double* displacement, BlockMatrix& stiffness) const override {
    addStiffness(displacement, nullptr, stiffness);
  }
  /// The same with contracted muscle. @param contraction  per node (ratio); null: where the wall is shorter along its
  /// muscle than at rest, the muscle is taken to have contracted by as much
  void addStiffness(const double* displacement, const float* contraction, BlockMatrix& stiffness) const;
  /// A third of the mass of each triangle per node.
  std::vector<double> lumpedMass(double density) const override;
  /// Square root of the ratio of the areas around the node to those at rest, minus 1.
  void strain(const double* displacement, float* out) const override;

  const ShellMesh& mesh() const { return mesh_; }  ///< as constructed

 private:
  struct Run {  // batches of one material and of triangles with as many rows
    int first, last, material, rows;
    std::size_t row;  // of the first batch in batch_rest_
  };
  static constexpr int kWindow = 16;  // batches that share a contiguous piece of the mesh

  void checkMesh() const;
  void findNeighbours();
  void measure();
  void measureSides(std::size_t triangle, const Eigen::Matrix<double, 3, 6>& patch, double* rest) const;
  void measureBending(std::size_t triangle, const Eigen::Matrix<double, 3, 6>& patch, double* rest) const;
  void checkFibres() const;
  void measureFibres();
  void measureMuscle();
  std::array<Eigen::Vector2d, 3> inSides(std::size_t triangle, const Eigen::Vector3d& along) const;
  void measureGhosts(std::size_t triangle, double* rest) const;
  Eigen::Matrix<double, 3, 6> restPatch(std::size_t triangle) const;
  void makeBatches();
  void addRun(const std::vector<int>& triangles, int material, int rows);
  void addBatch(const std::vector<int>& triangles, int rows);
  int firstBatch(int piece) const;
  ShellPart makePart(int first_piece, int last_piece, std::vector<int>& place) const;
  void setRun(const Run& run, ShellSweep& sweep) const;
  double evaluateRun(const Run& run, int first_node_batch, ShellSweep& sweep) const;
  double sweepRuns(double (*function)(ShellSweep&), ShellSweep sweep) const;
  double evaluatePiece(int piece, ShellSweep sweep, int first_node_batch, double* volume, ConstantStress* beside) const;

  double areaOf(std::size_t triangle) const;
  bool held(int node) const { return !mesh_.fixed.empty() && mesh_.fixed[static_cast<std::size_t>(node)] != 0; }
  /// All of its nodes are held: what is beyond its sides is clamped to it.
  bool rigid(std::size_t triangle) const {
    const auto& t = mesh_.triangles[triangle];
    return held(t[0]) && held(t[1]) && held(t[2]);
  }
  bool atBoundary(std::size_t triangle) const;
  bool hasMuscle(std::size_t triangle) const {
    return !mesh_.muscle.empty() && !mesh_.muscle[triangle].isZero() && !atBoundary(triangle);
  }
  int patchNode(std::size_t triangle, int k) const { return patch_nodes_[6 * triangle + static_cast<std::size_t>(k)]; }
  const double* rest(std::size_t triangle) const;
  int materialOf(std::size_t triangle) const { return mesh_.material.empty() ? 0 : mesh_.material[triangle]; }
  /// Of a number per node.
  double meanOf(const float* values, std::size_t triangle) const {
    const auto& t = mesh_.triangles[triangle];
    return (static_cast<double>(values[t[0]]) + values[t[1]] + values[t[2]]) / 3;
  }
  /// Displacements of the patch relative to node 1, ghosts included.
  void gather(std::size_t triangle, const double* displacement, double (&v)[5][3]) const;

  ShellMesh mesh_;
  Eigen::Vector3d origin_;
  std::unique_ptr<const ShellKernel> kernel_;
  std::vector<LawConstants> constants_;  // per material
  std::vector<int> patch_nodes_;         // (triangles * 6), -1: ghost
  std::vector<char> released_;           // (triangles * 3) sides hinged by ShellMesh::hinged
  std::vector<double> rest_;             // (triangles * kShellMuscleRows)
  std::vector<double> rest_area_;        // (nodes) of the triangles around the node [m^2]
  int batch_count_ = 0, piece_count_ = 1;
  std::vector<Run> runs_;
  std::vector<BatchOffsets> batch_node_;
  std::vector<BatchReals> batch_rest_;
  std::vector<double> fibre_rest_;  // (triangles * kFibreRows), empty without fibres
  std::vector<BatchReals> batch_fibre_;
};

}  // namespace vibe
