#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "arithmetic/elementary.hpp"
#include "arithmetic/symmetric_eigen.hpp"
#include "tissue/shell_fibres.hpp"
#include "vibe_core/tissue/shell.hpp"

namespace vibe {
namespace {

using Matrix18 = Eigen::Matrix<double, 18, 18>;
using Rows18 = Eigen::Matrix<double, 3, 18>;  // derivatives of three numbers with respect to nodes 1 to 6

constexpr int kSteps = 12;
constexpr double kLeastStretch2 = 0.1;  // of a muscle, squared: it shortens to a third at most

// Derivatives of the plane-stress energy with respect to C, in the orthonormal basis 11, 22, sqrt(2) 12 of symmetric
// matrices.
struct WallTangent {
  Eigen::Vector3d first;
  Eigen::Matrix3d second;
};

Eigen::Matrix3d withoutNegative(const Eigen::Matrix3d& symmetric) {
  if (symmetric.llt().info() == Eigen::Success) return symmetric;
  const SymmetricEigen3 solver(symmetric);
  return solver.vectors * solver.values.cwiseMax(0.0).asDiagonal() * solver.vectors.transpose();
}

// With y eliminated by g(t, D, y) = 2 W_I y + W_J = 0, t = tr C: W_ab - D g_a g_b / g_y, where W_y = D g.
template <Law law>
WallTangent wallTangent(const WallTerms<double>& terms, const Eigen::Vector3d& s) {
  const double minor_strain = s[0] * s[1] - s[2] * s[2] / 2, more = s[0] + s[1] + minor_strain, area = 1 + more;
  const double square = planeStress<law, kSteps>(terms, s[0] + s[1], minor_strain).square;
  const double y = std::sqrt(1 + square), eta = square / (1 + y);
  const ThicknessStep<double> at = thicknessStep<law>(terms.law, area, more, minor_strain, eta);
  const LawAt<double>& w = at.w;
  const double by_t = 2 * y * w.by_ii + w.by_ij;
  const double by_d = y * (2 * y * (y * w.by_ii + w.by_ij) + y * w.by_ij + w.by_jj);
  const double eliminated = area / at.slope;
  const double tt = w.by_ii - eliminated * by_t * by_t;
  const double td = y * (y * w.by_ii + w.by_ij) - eliminated * by_t * by_d;
  const double dd = y * y * (y * y * w.by_ii + 2 * y * w.by_ij + w.by_jj) - eliminated * by_d * by_d;
  const double d = -y * y * w.by_i;
  const Eigen::Vector3d unit(1, 1, 0), cof(1 + s[1], 1 + s[0], -s[2]);
  WallTangent out;
  out.first = {d * s[1] - w.by_i * square, d * s[0] - w.by_i * square, -d * s[2]};
  out.second = tt * unit * unit.transpose() + td * (unit * cof.transpose() + cof * unit.transpose()) +
               dd * cof * cof.transpose();
  out.second(0, 1) += d, out.second(1, 0) += d, out.second(2, 2) -= d;
  return out;
}

struct FibresOf {
  const double* row;  // null: none
  double stiffening;
};

// Their derivatives are positive, so no part is removed.
void addFibres(const FibresOf& fibres, int side, const double (&s)[3], Eigen::Matrix3d& second, double (&first)[3]) {
  for (int family = 0; family < 2; ++family) {
    const double* direction = fibres.row + kFibreSide + 4 * side + 2 * family;
    const double c = direction[0], n = direction[1], strain = c * c * s[0] + 2 * c * n * s[1] + n * n * s[2];
    if (strain <= 0) continue;
    const FibreAt<double> w =
        fibreAt(fibres.row[kFibreModulus], fibres.stiffening, fibreReach(fibres.stiffening), strain);
    const Eigen::Vector3d m(c * c, n * n, std::sqrt(2.0) * c * n);
    second += w.second * m * m.transpose();
    first[0] += w.first * c * c, first[1] += w.first * c * n, first[2] += w.first * n * n;
  }
}

// The muscle of a side; null: none. A contraction below 0 is not known.
struct MuscleOf {
  const double* row;
  double contraction;
};

// The contraction with which a wall has its length along the muscle.
// @param s  strain of the wall
double likelyContraction(const double* muscle, const double (&s)[3]) {
  const double c = muscle[0], n = muscle[1], stretch2 = 1 + c * c * s[0] + 2 * c * n * s[1] + n * n * s[2];
  return stretch2 < 1 ? 1 / std::sqrt(std::max(stretch2, kLeastStretch2)) - 1 : 0;
}

// Derivatives with respect to e and d of a side: 3 x 3 blocks ee, ed, dd.
struct SideBlocks {
  Eigen::Matrix3d ee, ed, dd;
};

SideBlocks sideBlocks(const Material& material, const WallTerms<double>& terms, const double* row,
                      const FibresOf& fibres, const MuscleOf& muscle, int side, const Eigen::Vector3d& e,
                      const Eigen::Vector3d& d, const Eigen::Vector3d& ue, const Eigen::Vector3d& ud) {
  double t[3] = {row[0], row[1], row[2]};
  const double volume = row[3] / 2, root = std::sqrt(2.0);
  const double change[3] = {ue.dot(2 * e + ue), (ue.dot(2 * d + ud) + (2 * e + ue).dot(ud)) / 2, ud.dot(2 * d + ud)};
  double s[3];
  pullBack(t, change, s);
  if (muscle.row != nullptr) {
    double grown[3];
    const double contraction = muscle.contraction < 0 ? likelyContraction(muscle.row, s) : muscle.contraction;
    shorten(contraction, muscle.row[0], muscle.row[1], t, grown);
    pullBack(t, change, s);
    for (int k = 0; k < 3; ++k) s[k] += grown[k];
  }
  const WallTangent w = withLaw(material.law, [&](auto tag) {
    return wallTangent<decltype(tag)::value>(terms, Eigen::Vector3d(s[0], s[2], root * s[1]));
  });
  const Eigen::Vector3d f1 = t[0] * (e + ue), f2 = t[1] * (e + ue) + t[2] * (d + ud);
  Eigen::Matrix<double, 3, 6> b;  // of C by e and d
  b.leftCols<3>() << 2 * t[0] * f1.transpose(), 2 * t[1] * f2.transpose(), root * (t[0] * f2 + t[1] * f1).transpose();
  b.rightCols<3>() << Eigen::RowVector3d::Zero(), 2 * t[2] * f2.transpose(), root * t[2] * f1.transpose();
  Eigen::Matrix3d second = withoutNegative(w.second);
  // the stress, without its negative principal values
  const double mean = (w.first[0] + w.first[1]) / 2, half = (w.first[0] - w.first[1]) / 2, shear = w.first[2] / root;
  const double radius = math::hypot(half, shear), high = std::max(mean + radius, 0.0),
               low = std::max(mean - radius, 0.0);
  const double middle = (high + low) / 2, scale = radius > 0 ? (high - low) / 2 / radius : 0;
  double g[3] = {middle + scale * half, scale * shear, middle - scale * half};
  if (fibres.row != nullptr) addFibres(fibres, side, s, second, g);
  const Eigen::Matrix<double, 6, 6> k = volume * b.transpose() * second * b;
  double a[3];
  pushForward(t, g, a);
  const Eigen::Matrix3d unit = 2 * volume * Eigen::Matrix3d::Identity();
  return {k.topLeftCorner<3, 3>() + a[0] * unit, k.topRightCorner<3, 3>() + a[1] * unit,
          k.bottomRightCorner<3, 3>() + a[2] * unit};
}

using Vectors = Eigen::Matrix<double, 3, 5>;  // nodes 2 to 6 relative to node 1

// e = node e_to minus node e_from, d likewise; 0 is node 1
struct SideNodes {
  int e_to, e_from, d_to, d_from;
};
constexpr SideNodes kSideNodes[3] = {{2, 1, 3, 0}, {2, 0, 1, 4}, {1, 0, 2, 5}};

Eigen::Vector3d between(const Vectors& x, int to, int from) {
  const Eigen::Vector3d end = x.col(to - 1);
  return from == 0 ? end : Eigen::Vector3d(end - x.col(from - 1));
}

void addMembrane(const Material& material, const WallTerms<double>& terms, const double* rest, const FibresOf& fibres,
                 MuscleOf muscle, const Vectors& x, const Vectors& u, bool whole, Matrix18& k) {
  for (int side = 0; side < 3; ++side) {
    const SideNodes& n = kSideNodes[side];
    const SideBlocks b = sideBlocks(material, terms, rest + kShellSide + 4 * side, fibres,
                                    {muscle.row != nullptr ? muscle.row + 2 * side : nullptr, muscle.contraction}, side,
                                    between(x, n.e_to, n.e_from), between(x, n.d_to, n.d_from),
                                    between(u, n.e_to, n.e_from), between(u, n.d_to, n.d_from));
    const int nodes[4] = {n.e_to, n.e_from, n.d_to, n.d_from};
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        if (!whole && nodes[i] < nodes[j]) continue;
        const double sign = (i + j) % 2 == 0 ? 1 : -1;
        auto block = k.block<3, 3>(3 * nodes[i], 3 * nodes[j]);
        if (i < 2 && j < 2) block += sign * b.ee;
        if (i < 2 && j >= 2) block += sign * b.ed;
        if (i >= 2 && j < 2) block += sign * b.ed.transpose();
        if (i >= 2 && j >= 2) block += sign * b.dd;
      }
  }
}

// Coefficients of the nodes 2 to 6 in the tangents and in the second derivatives.
constexpr double kTangent[2][5] = {{4, 0, 1, -1, 0}, {0, 4, 1, 0, -1}};
constexpr double kSecond[3][5] = {{0, -2, 1, 1, 0}, {-1, -1, 1, 0, 0}, {-2, 0, 1, 0, 1}};

// Derivatives of the covariant curvature, as far as the energy is of second order in it, including the change of the
// thickness with the area.
Rows18 curvatureRows(const Bent<double>& s) {
  using Vector = Eigen::Map<const Eigen::Vector3d>;
  const Vector n(s.n), g0(s.g[0]), g1(s.g[1]);
  const double pull = s.thin < kThinningStart ? -2 * s.inverse : 0;
  Rows18 out = Rows18::Zero();
  for (int row = 0; row < 3; ++row) {
    const Eigen::Vector3d q = Vector(s.rest_h[row]) + Vector(s.move_h[row]);
    const Eigen::Vector3d p = s.inverse * (q - n * n.dot(q)) + pull * s.change[row] * n;
    const Eigen::Vector3d by_g0 = g1.cross(p), by_g1 = p.cross(g0);
    for (int a = 0; a < 5; ++a) {
      const Eigen::Vector3d v = kTangent[0][a] * by_g0 + kTangent[1][a] * by_g1 + kSecond[row][a] * n;
      out.block<1, 3>(row, 3 * (a + 1)) = v.transpose();
      out.block<1, 3>(row, 0) -= v.transpose();
    }
  }
  return out;
}

void addBending(const WallTerms<double>& terms, const double* rest, const Patch<double>& x, const Patch<double>& u,
                bool whole, Matrix18& k) {
  const auto rows = [rest](int row) { return rest[row]; };
  const Bent<double> s = bentSurface(rows, x, u);
  const BendingFactor<double> factor = bendingFactor(terms, s.thin);
  const Rows18 b = curvatureRows(s);
  const Eigen::Map<const Eigen::Vector3d> g0(s.g[0]), g1(s.g[1]);
  const Eigen::Vector3d trace(g1.dot(g1), -2 * g0.dot(g1), g0.dot(g0));
  Eigen::Matrix3d law = 2 * factor.mean * trace * trace.transpose();
  const double gauss = 2 * (1 - terms.poisson_ratio) * s.square;
  law(0, 2) -= gauss, law(2, 0) -= gauss, law(1, 1) += 2 * gauss;
  const Rows18 moment = rest[kShellBend] * factor.whole * law * b;
  const Eigen::Matrix<double, 18, 3> columns = b.transpose();
  for (int j = 0; j < 18; ++j) {
    const int first = whole ? 0 : j / 3 * 3;
    const double m0 = moment(0, j), m1 = moment(1, j), m2 = moment(2, j);
    for (int i = first; i < 18; ++i) k(i, j) += m0 * columns(i, 0) + m1 * columns(i, 1) + m2 * columns(i, 2);
  }
}

// Folds the derivatives of the ghosts into those of the other nodes.
// @param clamp  as clampGhosts places them
void foldGhosts(const double* rest, bool clamp, Matrix18& k) {
  for (int side = 0; side < 3; ++side) {
    const double* row = rest + kShellGhost + 4 * side;
    if (row[0] != 0) continue;
    const Eigen::Map<const Eigen::Vector3d> m(row + 1);
    const Eigen::Matrix3d mirror = clamp ? Eigen::Matrix3d(m * m.transpose()) : Eigen::Matrix3d::Zero();
    Eigen::Matrix<double, 3, 18> map = Eigen::Matrix<double, 3, 18>::Zero();
    for (const int node : kBeside[side]) map.block<3, 3>(0, 3 * node) = Eigen::Matrix3d::Identity() - mirror / 2;
    map.block<3, 3>(0, 3 * side) = mirror - Eigen::Matrix3d::Identity();
    const int ghost = 3 * (side + 3);
    const Eigen::Matrix<double, 3, 18> rows = k.middleRows<3>(ghost);
    k.noalias() += map.transpose() * rows;
    const Eigen::Matrix<double, 18, 3> columns = k.middleCols<3>(ghost);
    k.noalias() += columns * map;
    k.middleRows<3>(ghost).setZero();
    k.middleCols<3>(ghost).setZero();
  }
}

}  // namespace

void ShellElements::addStiffness(const double* displacement, const float* contraction, BlockMatrix& stiffness) const {
  const int* place = stiffness.placesOf(patch_nodes_, 6).data();
  for (std::size_t e = 0; e < mesh_.triangles.size(); ++e) {
    const auto material = static_cast<std::size_t>(materialOf(e));
    const Material& m = mesh_.materials[material];
    Patch<double> u, x;
    gather(e, displacement, u);
    std::copy(rest(e) + kShellPatch, rest(e) + kShellPatch + 15, &x[0][0]);
    Matrix18 k = Matrix18::Zero();
    const bool whole = atBoundary(e);  // folding needs the blocks above the diagonal too
    const FibresOf fibres{fibre_rest_.empty() ? nullptr : &fibre_rest_[kFibreRows * e], mesh_.fibres.stiffening};
    addMembrane(m, WallTerms<double>(constants_[material], m.poisson_ratio), rest(e), fibres,
                {hasMuscle(e) ? rest(e) + kShellMuscle : nullptr, contraction != nullptr ? meanOf(contraction, e) : -1},
                Eigen::Map<const Vectors>(&x[0][0]), Eigen::Map<const Vectors>(&u[0][0]), whole, k);
    if (whole) {
      foldGhosts(rest(e), false, k);
      clampGhosts([rows = rest(e)](int row) { return rows[row]; }, u);
    }
    addBending(WallTerms<double>(constants_[material], m.poisson_ratio), rest(e), x, u, whole, k);
    if (whole) foldGhosts(rest(e), true, k);
    for (int a = 0; a < 6; ++a)
      for (int b = 0; b <= a; ++b, ++place) {
        if (*place == BlockMatrix::kNowhere) continue;
        const auto block = k.block<3, 3>(3 * a, 3 * b);
        stiffness.addAt(*place, block);
        // a node that is the apex beyond two sides
        if (*place < 0 && a != b) stiffness.addAt(*place, block.transpose());
      }
  }
}

}  // namespace vibe
