#pragma once
#include <cmath>

#include "vibe_core/tissue/material_registry.hpp"

// The energy of one tetrahedron and its gradient, in single or double precision.

namespace vibe::benchmarks {

// Barycentric coordinates of the four integration points: one is kGaussNear, the others are kGaussFar.
constexpr double kGaussNear = 0.58541019662496845446;
constexpr double kGaussFar = 0.13819660112501051518;

/// Number of the node on the edge between two vertices of a quadratic tetrahedron; for a = b the vertex itself.
constexpr int kEdgeNode[4][4] = {{0, 4, 6, 7}, {4, 1, 5, 8}, {6, 5, 2, 9}, {7, 8, 9, 3}};

/// a b + c, in single precision rounded once: the bits of the core's kernels.
inline float mulAdd(float a, float b, float c) {
  return std::fma(a, b, c);
}
inline double mulAdd(double a, double b, double c) {
  return a * b + c;
}

/// c - a b
template <class Real>
Real minusMul(Real a, Real b, Real c) {
  return mulAdd(-a, b, c);
}

/// Cofactors of h.
template <class Real>
void cofactors(const Real (&h)[3][3], Real (&cof)[3][3]) {
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) {
      const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
      cof[r][c] = minusMul(h[r1][c2], h[r2][c1], h[r1][c1] * h[r2][c2]);
    }
}

/// Energy of a volume as a function of the displacement gradient h, and its derivative with respect to h:
/// P = 2 W_I (F - cof F) + balance cof F with cof F = (1 + tr h) 1 - ht + cof h.
template <class Real>
Real strainEnergy(const MaterialEnergy& law, const Real (&h)[3][3], const Real& volume, Real (&p)[3][3]) {
  Real cof[3][3];
  cofactors(h, cof);
  const Real trace = h[0][0] + h[1][1] + h[2][2];
  Real higher = cof[0][0] + cof[1][1] + cof[2][2];  // J - 1 - trace
  for (int c = 0; c < 3; ++c) higher = mulAdd(h[0][c], cof[0][c], higher);
  Real square = h[0][0] * h[0][0];
  for (int k = 1; k < 9; ++k) square = mulAdd(h[k / 3][k % 3], h[k / 3][k % 3], square);
  const Real two = Real(2);
  const EnergyDerivatives<Real> w = law.at(mulAdd(two, trace, square), trace + higher, minusMul(two, higher, square));
  const Real direct = two * w.by_i * volume, balance = w.balance * volume, mixed = direct - balance;
  const Real diagonal = minusMul(mixed, trace, balance);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) {
      const Real sum = mulAdd(direct, h[r][c], mixed * (h[c][r] - cof[r][c]));
      p[r][c] = r == c ? sum + diagonal : sum;
    }
  return w.energy * volume;
}

/// Energy contribution of an integration point, and its derivative with respect to the edges.
/// @param edge   derivatives of the displacement with respect to barycentric coordinates 1, 2, 3, minus that of
///         coordinate 0
/// @param rest   (row) -> ten rows of TetElements
/// @param force  of the three edges, overwritten
template <class Real, class Rest>
Real pointEnergy(const MaterialEnergy& law, const Real (&edge)[3][3], const Rest& rest, Real (&force)[3][3]) {
  Real h[3][3], p[3][3];
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c)
      h[r][c] = mulAdd(edge[2][r], rest(6 + c), mulAdd(edge[1][r], rest(3 + c), edge[0][r] * rest(c)));
  const Real energy = strainEnergy(law, h, rest(9), p);
  for (int i = 0; i < 3; ++i)
    for (int r = 0; r < 3; ++r)
      force[i][r] = mulAdd(p[r][2], rest(3 * i + 2), mulAdd(p[r][1], rest(3 * i + 1), p[r][0] * rest(3 * i)));
  return energy;
}

template <class Real, class Rest>
Real linearEnergy(const MaterialEnergy& law, const Real (&u)[4][3], const Rest& rest, Real (&force)[4][3]) {
  Real edge[3][3], pull[3][3];
  for (int i = 0; i < 3; ++i)
    for (int r = 0; r < 3; ++r) edge[i][r] = u[i + 1][r] - u[0][r];
  const auto row = [&](int k) { return rest(0, k); };
  const Real energy = pointEnergy(law, edge, row, pull);
  for (int r = 0; r < 3; ++r) {
    force[0][r] = -(pull[0][r] + pull[1][r] + pull[2][r]);
    for (int i = 0; i < 3; ++i) force[i + 1][r] = pull[i][r];
  }
  return energy;
}

// Quadratic displacements: the derivative with respect to coordinate i at point k is base_i + kSteep u_(ik), where
// u_(ik) is on the edge between the two vertices (u_k for i = k) and base_i = kCorner u_i + kMiddle (sum of the edges
// at i).
constexpr double kCorner = 4 * kGaussFar - 1;
constexpr double kMiddle = 4 * kGaussFar;
constexpr double kSteep = 4 * (kGaussNear - kGaussFar);

template <class Real>
void edgesAt(int point, const Real (&u)[10][3], const Real (&base)[4][3], Real (&edge)[3][3]) {
  const Real steep = static_cast<Real>(kSteep);
  for (int r = 0; r < 3; ++r) {
    const Real first = mulAdd(steep, u[kEdgeNode[0][point]][r], base[0][r]);
    for (int i = 0; i < 3; ++i) edge[i][r] = mulAdd(steep, u[kEdgeNode[i + 1][point]][r], base[i + 1][r]) - first;
  }
}

// The transpose of edgesAt: adds to the nodes directly, and to the sums that belong to base.
template <class Real>
void addPull(int point, const Real (&pull)[3][3], Real (&sum)[4][3], Real (&force)[10][3]) {
  const Real steep = static_cast<Real>(kSteep);
  for (int r = 0; r < 3; ++r) {
    const Real last = -(pull[0][r] + pull[1][r] + pull[2][r]);
    for (int i = 0; i < 4; ++i) {
      const Real part = i == 0 ? last : pull[i - 1][r];
      sum[i][r] = sum[i][r] + part;
      Real& target = force[kEdgeNode[i][point]][r];
      target = mulAdd(steep, part, target);
    }
  }
}

template <class Real, class Rest>
Real quadraticEnergy(const MaterialEnergy& law, const Real (&u)[10][3], const Rest& rest, Real (&force)[10][3]) {
  const Real corner = static_cast<Real>(kCorner), middle = static_cast<Real>(kMiddle), zero = Real(0);
  Real edge[3][3], pull[3][3], base[4][3], sum[4][3];
  for (int i = 0; i < 4; ++i)
    for (int r = 0; r < 3; ++r) {
      const int *edges = kEdgeNode[i], a = (i + 1) % 4, b = (i + 2) % 4, c = (i + 3) % 4;
      base[i][r] = mulAdd(corner, u[i][r], middle * (u[edges[a]][r] + u[edges[b]][r] + u[edges[c]][r]));
      sum[i][r] = zero;
    }
  for (auto& node : force) node[0] = zero, node[1] = zero, node[2] = zero;
  Real energy = zero;
  for (int point = 0; point < 4; ++point) {
    edgesAt(point, u, base, edge);
    const auto row = [&](int number) { return rest(point, number); };
    energy = energy + pointEnergy(law, edge, row, pull);
    addPull(point, pull, sum, force);
  }
  for (int i = 0; i < 4; ++i)
    for (int r = 0; r < 3; ++r) {
      force[i][r] = mulAdd(corner, sum[i][r], force[i][r]);
      for (int other = 0; other < i; ++other) {
        Real& target = force[kEdgeNode[i][other]][r];
        target = mulAdd(middle, sum[i][r] + sum[other][r], target);
      }
    }
  return energy;
}

/// Energy of an element; the gradient is written to `force`.
/// @param u     displacements of the nodes
/// @param rest  (point, row) -> the rows of TetElements
template <int Nodes, class Real, class Rest>
Real elementEnergy(const MaterialEnergy& law, const Real (&u)[Nodes][3], const Rest& rest, Real (&force)[Nodes][3]) {
  if constexpr (Nodes == 4) {
    return linearEnergy(law, u, rest, force);
  } else {
    return quadraticEnergy(law, u, rest, force);
  }
}

}  // namespace vibe::benchmarks
