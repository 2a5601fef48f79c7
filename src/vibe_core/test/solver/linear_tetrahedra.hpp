#pragma once
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "vibe_core/tissue/elastic_elements.hpp"
#include "vibe_core/tissue/material_registry.hpp"
#include "vibe_testing/tet_box.hpp"

/// Solids for the tests of implicit steps, in double precision throughout.
namespace vibe::test {

struct TetMesh {
  std::vector<Eigen::Vector3d> nodes;        ///< [m]
  std::vector<std::array<int, 4>> elements;  ///< node numbers; from node 3, 0 1 2 are counter-clockwise
  Material material;
};

inline TetMesh tetBox(std::array<int, 3> cubes, double side, const Material& material) {
  TetBox box = kuhnBox(cubes, side);
  return {std::move(box.nodes), std::move(box.elements), material};
}

/// Linear tetrahedra of any law, with the exact second derivative less its negative eigenvalues.
class LinearTetrahedra : public ElasticElements {
 public:
  explicit LinearTetrahedra(TetMesh mesh) : mesh_(std::move(mesh)), law_(mesh_.material) {
    for (const auto& element : mesh_.elements) {
      Eigen::Matrix3d edges;
      for (int k = 0; k < 3; ++k) edges.col(k) = node(element[k + 1]) - node(element[0]);
      Eigen::Matrix<double, 4, 3>& gradient = gradient_.emplace_back();
      gradient.bottomRows<3>() = edges.inverse();
      gradient.row(0) = -gradient.bottomRows<3>().colwise().sum();
      volume_.push_back(edges.determinant() / 6);
      flat_nodes_.insert(flat_nodes_.end(), element.begin(), element.end());
    }
  }

  const TetMesh& mesh() const { return mesh_; }
  int nodeCount() const override { return static_cast<int>(mesh_.nodes.size()); }
  int pieceCount() const override { return 1; }

  double evaluate(int, const float* displacement4, float* gradient4) const override {
    return evaluateAll([=](int n, int r) { return static_cast<double>(displacement4[4 * n + r]); },
                       [=](int n, int r, double force) { gradient4[4 * n + r] += static_cast<float>(force); });
  }
  double evaluate(const double* displacement, double* gradient) const override {
    std::fill(gradient, gradient + 3 * mesh_.nodes.size(), 0.0);
    return evaluateAll([=](int n, int r) { return displacement[3 * n + r]; },
                       [=](int n, int r, double force) { gradient[3 * n + r] += force; });
  }

  std::vector<std::pair<const std::vector<int>*, int>> nodeGroups() const override { return {{&flat_nodes_, 4}}; }

  void addStiffness(const double* displacement, BlockMatrix& stiffness) const override {
    for (std::size_t e = 0; e < mesh_.elements.size(); ++e) {
      const Matrix9 tangent =
          volume_[e] * tangentAt(strainOf(e, [=](int n, int r) { return displacement[3 * n + r]; }));
      for (int a = 0; a < 4; ++a)
        for (int b = 0; b <= a; ++b) {
          Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
          for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
              block += gradient_[e](a, i) * gradient_[e](b, j) * tangent.block<3, 3>(3 * i, 3 * j);
          if (a == b) block = (0.5 * (block + block.transpose())).eval();
          stiffness.add(mesh_.elements[e][a], mesh_.elements[e][b], block);
        }
    }
  }

  std::vector<double> lumpedMass(double density) const override {
    std::vector<double> mass(mesh_.nodes.size(), 0.0);
    for (std::size_t e = 0; e < mesh_.elements.size(); ++e)
      for (const int n : mesh_.elements[e]) mass[static_cast<std::size_t>(n)] += density * volume_[e] / 4;
    return mass;
  }
  void strain(const double*, float* out) const override { std::fill(out, out + mesh_.nodes.size(), 0.0F); }

 private:
  using Vector9 = Eigen::Matrix<double, 9, 1>;
  using Matrix9 = Eigen::Matrix<double, 9, 9>;

  const Eigen::Vector3d& node(int n) const { return mesh_.nodes[static_cast<std::size_t>(n)]; }

  /// F - 1
  template <class Displacement>
  Eigen::Matrix3d strainOf(std::size_t e, const Displacement& u) const {
    Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
    for (int a = 0; a < 4; ++a) {
      const int n = mesh_.elements[e][a];
      h += Eigen::Vector3d(u(n, 0), u(n, 1), u(n, 2)) * gradient_[e].row(a);
    }
    return h;
  }

  EnergyDerivatives<double> lawAt(const Eigen::Matrix3d& h) const {
    const double trace = h.trace(), square = h.squaredNorm();
    const double higher = (trace * trace - (h * h).trace()) / 2 + h.determinant();  // J - 1 - trace
    return law_.at(2 * trace + square, trace + higher, square - 2 * higher);
  }

  /// Derivative of J with respect to F.
  static Eigen::Matrix3d cofactors(const Eigen::Matrix3d& f) {
    Eigen::Matrix3d c;
    for (int k = 0; k < 3; ++k) c.col(k) = f.col((k + 1) % 3).cross(f.col((k + 2) % 3));
    return c;
  }

  template <class Displacement, class AddForce>
  double evaluateAll(const Displacement& u, const AddForce& addForce) const {
    double energy = 0;
    for (std::size_t e = 0; e < mesh_.elements.size(); ++e) {
      const Eigen::Matrix3d h = strainOf(e, u), f = h + Eigen::Matrix3d::Identity(), c = cofactors(f);
      const EnergyDerivatives<double> w = lawAt(h);
      const Eigen::Matrix3d stress = volume_[e] * (2 * w.by_i * (f - c) + w.balance * c);
      energy += volume_[e] * w.energy;
      for (int a = 0; a < 4; ++a) {
        const Eigen::Vector3d force = stress * gradient_[e].row(a).transpose();
        for (int r = 0; r < 3; ++r) addForce(mesh_.elements[e][a], r, force[r]);
      }
    }
    return energy;
  }

  /// Second derivative of the energy per volume with respect to F, column by column.
  Matrix9 tangentAt(const Eigen::Matrix3d& h) const {
    const EnergyDerivatives<double> w = lawAt(h);
    const Eigen::Matrix3d f = h + Eigen::Matrix3d::Identity(), c = cofactors(f);
    const Eigen::Map<const Vector9> vf(f.data()), vc(c.data());
    Matrix9 tangent = 2 * w.by_i * Matrix9::Identity() + 4 * w.by_ii * vf * vf.transpose() +
                      2 * w.by_ij * (vf * vc.transpose() + vc * vf.transpose()) + w.by_jj * vc * vc.transpose();
    for (int k = 0; k < 3; ++k)
      for (int r = 0; r < 3; ++r) {  // the cofactors are linear in the column k
        Eigen::Matrix3d unit = Eigen::Matrix3d::Zero();
        unit(r, k) = 1;
        Eigen::Matrix3d change = Eigen::Matrix3d::Zero();
        change.col((k + 1) % 3) = f.col((k + 2) % 3).cross(unit.col(k));
        change.col((k + 2) % 3) = unit.col(k).cross(f.col((k + 1) % 3));
        tangent.col(3 * k + r) += w.by_j * Eigen::Map<const Vector9>(change.data());
      }
    const Eigen::SelfAdjointEigenSolver<Matrix9> solver(0.5 * (tangent + tangent.transpose()));
    return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).asDiagonal() * solver.eigenvectors().transpose();
  }

  TetMesh mesh_;
  MaterialEnergy law_;
  std::vector<Eigen::Matrix<double, 4, 3>> gradient_;  // of the shape functions, per element and node [1/m]
  std::vector<double> volume_;                         // [m^3]
  std::vector<int> flat_nodes_;
};

}  // namespace vibe::test
