#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "tetrahedra/tetrahedra.hpp"
#include "tetrahedra/tetrahedron_energy.hpp"

// Derivatives of the energy of an integration point in the frame of its principal stretches. There the tangent of a law
// of I and J splits into one 3 x 3 block and three 2 x 2 blocks: Smith, de Goes, Kim 2019.

namespace vibe::benchmarks {
namespace {

// F = u diag(stretch) vt with rotations u and v; the product of the stretches has the sign of det F.
struct Principal {
  Eigen::Matrix3d u, v;
  Eigen::Vector3d stretch;
};

Principal principal(const Eigen::Matrix3d& deformation) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(deformation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Principal p{svd.matrixU(), svd.matrixV(), svd.singularValues()};
  if (p.u.determinant() < 0) p.u.col(2) *= -1, p.stretch[2] *= -1;
  if (p.v.determinant() < 0) p.v.col(2) *= -1, p.stretch[2] *= -1;
  return p;
}

// Tangent in the principal frame, positive semidefinite.
struct Tangent {
  Eigen::Matrix3d scaling;  // entries rr, ss
  Eigen::Vector3d shear;    // entry rc, rc by the third axis
  Eigen::Vector3d swap;     // entry rc, cr by the third axis
};

Eigen::Matrix3d withoutNegativeEigenvalues(const Eigen::Matrix3d& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(symmetric);
  if (solver.eigenvalues()[0] >= 0) return symmetric;
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).asDiagonal() * solver.eigenvectors().transpose();
}

Tangent tangent(const Eigen::Vector3d& s, const EnergyDerivatives<double>& w) {
  const Eigen::Vector3d cof(s[1] * s[2], s[2] * s[0], s[0] * s[1]);
  Eigen::Matrix3d a = 4 * w.by_ii * s * s.transpose() + w.by_jj * cof * cof.transpose() +
                      2 * w.by_ij * (s * cof.transpose() + cof * s.transpose());
  Tangent out;
  for (int k = 0; k < 3; ++k) {
    const int r = (k + 1) % 3, c = (k + 2) % 3;
    a(k, k) += 2 * w.by_i;
    a(r, c) += w.by_j * s[k];
    a(c, r) += w.by_j * s[k];
    const double twist = std::max(2 * w.by_i + w.by_j * s[k], 0.0), flip = std::max(2 * w.by_i - w.by_j * s[k], 0.0);
    out.shear[k] = (flip + twist) / 2;
    out.swap[k] = (flip - twist) / 2;
  }
  out.scaling = withoutNegativeEigenvalues(a);
  return out;
}

EnergyDerivatives<double> lawOf(const MaterialEnergy& law, const Eigen::Matrix3d& h) {
  const double trace = h.trace(), square = h.squaredNorm();
  const double higher = (trace * trace - (h * h).trace()) / 2 + h.determinant();
  return law.at(2 * trace + square, trace + higher, square - 2 * higher);
}

// Second derivative of the energy of the point with respect to the displacements of two nodes with shape gradients a
// and b, all in the principal frame.
Eigen::Matrix3d blockOf(const Tangent& t, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  Eigen::Matrix3d k = a.asDiagonal() * t.scaling * b.asDiagonal();
  for (int axis = 0; axis < 3; ++axis) {
    const int r = (axis + 1) % 3, c = (axis + 2) % 3;
    k(r, r) += t.shear[axis] * a[c] * b[c];
    k(c, c) += t.shear[axis] * a[r] * b[r];
    k(r, c) += t.swap[axis] * a[c] * b[r];
    k(c, r) += t.swap[axis] * a[r] * b[c];
  }
  return k;
}

template <int Nodes>
using ShapeGradients = Eigen::Matrix<double, 3, Nodes>;

// Gradients of the shape functions at an integration point from those of the barycentric coordinates.
template <int Nodes>
ShapeGradients<Nodes> shapeGradients(const double* rest, int point) {
  Eigen::Matrix<double, 3, 4> g;
  for (int i = 0; i < 3; ++i)
    for (int c = 0; c < 3; ++c) g(c, i + 1) = rest[3 * i + c];
  g.col(0) = -(g.col(1) + g.col(2) + g.col(3));
  if constexpr (Nodes == 4) {
    return g;
  } else {
    const auto coordinate = [point](int i) { return i == point ? kGaussNear : kGaussFar; };
    ShapeGradients<Nodes> out;
    for (int i = 0; i < 4; ++i) {
      out.col(i) = (4 * coordinate(i) - 1) * g.col(i);
      for (int k = 0; k < i; ++k) out.col(kEdgeNode[i][k]) = 4 * (coordinate(k) * g.col(i) + coordinate(i) * g.col(k));
    }
    return out;
  }
}

template <int Nodes>
Eigen::Matrix3d displacementGradient(const double* displacement, const std::array<int, Nodes>& nodes,
                                     const ShapeGradients<Nodes>& shape) {
  Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
  for (int a = 0; a < Nodes; ++a)
    h += Eigen::Map<const Eigen::Vector3d>(displacement + 3 * nodes[a]) * shape.col(a).transpose();
  return h;
}

}  // namespace

template <int Nodes>
void TetElements<Nodes>::addStiffness(const double* displacement, BlockMatrix& stiffness) const {
  for (std::size_t e = 0; e < mesh_.elements.size(); ++e) {
    const auto& nodes = mesh_.elements[e];
    const MaterialEnergy& law = laws_[static_cast<std::size_t>(materialOf(e))];
    std::array<Eigen::Matrix3d, Nodes*(Nodes + 1) / 2> blocks;
    blocks.fill(Eigen::Matrix3d::Zero());
    for (int point = 0; point < kPoints; ++point) {
      const ShapeGradients<Nodes> shape = shapeGradients<Nodes>(rest(e, point), point);
      const Eigen::Matrix3d h = displacementGradient<Nodes>(displacement, nodes, shape);
      const Principal p = principal(h + Eigen::Matrix3d::Identity());
      const Tangent t = tangent(p.stretch, lawOf(law, h));
      const ShapeGradients<Nodes> turned = p.v.transpose() * shape;
      const Eigen::Matrix3d weighted = rest(e, point)[9] * p.u;
      std::size_t k = 0;
      for (int a = 0; a < Nodes; ++a)
        for (int b = 0; b <= a; ++b)
          blocks[k++] += weighted * blockOf(t, turned.col(a), turned.col(b)) * p.u.transpose();
    }
    std::size_t k = 0;
    for (int a = 0; a < Nodes; ++a)
      for (int b = 0; b <= a; ++b) stiffness.add(nodes[a], nodes[b], blocks[k++]);
  }
}

template <int Nodes>
void TetElements<Nodes>::strain(const double* displacement, float* out) const {
  std::vector<double> sum(mesh_.nodes.size(), 0.0), weight(mesh_.nodes.size(), 0.0);
  for (std::size_t e = 0; e < mesh_.elements.size(); ++e) {
    double square = 0;
    for (int point = 0; point < kPoints; ++point) {
      const double* rows = rest(e, point);
      const Eigen::Matrix3d h =
          displacementGradient<Nodes>(displacement, mesh_.elements[e], shapeGradients<Nodes>(rows, point));
      square += rows[9] * (h + Eigen::Matrix3d::Identity()).squaredNorm() / 3;
    }
    for (const int node : mesh_.elements[e]) {
      sum[static_cast<std::size_t>(node)] += square;
      weight[static_cast<std::size_t>(node)] += volumeOf(e);
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i)
    out[i] = weight[i] > 0 ? static_cast<float>(std::sqrt(sum[i] / weight[i]) - 1) : 0.0f;
}

template void TetElements<4>::addStiffness(const double*, BlockMatrix&) const;
template void TetElements<10>::addStiffness(const double*, BlockMatrix&) const;
template void TetElements<4>::strain(const double*, float*) const;
template void TetElements<10>::strain(const double*, float*) const;

}  // namespace vibe::benchmarks
