#pragma once

#include "tissue/shell_kernel.hpp"
#include "tissue/shell_plane_stress.hpp"

// The membrane energy of one triangle of a shell, its stress and its gradient, for one triangle or a pack of them;
// law_terms.hpp explains why everything is in an unnamed namespace.

namespace vibe {
namespace {

template <class B>
[[gnu::always_inline]] inline B dot(const B (&a)[3], const B (&b)[3]) {
  return mulAdd(a[2], b[2], B(mulAdd(a[1], b[1], B(a[0] * b[0]))));
}
template <class B>
[[gnu::always_inline]] inline void cross(const B (&a)[3], const B (&b)[3], B (&out)[3]) {
  for (int r = 0; r < 3; ++r) out[r] = minor(a[(r + 1) % 3], b[(r + 2) % 3], a[(r + 2) % 3], b[(r + 1) % 3]);
}

/// Symmetric 2 x 2 matrices: 11, 12, 22.
/// T^T a T for an upper triangular T
template <class B>
[[gnu::always_inline]] inline void pullBack(const B (&t)[3], const B (&a)[3], B (&out)[3]) {
  const B x = mulAdd(t[1], a[0], B(t[2] * a[1])), y = mulAdd(t[1], a[1], B(t[2] * a[2]));
  out[0] = t[0] * t[0] * a[0];
  out[1] = t[0] * x;
  out[2] = mulAdd(t[1], x, B(t[2] * y));
}
/// T g T^T
template <class B>
[[gnu::always_inline]] inline void pushForward(const B (&t)[3], const B (&g)[3], B (&out)[3]) {
  const B x = mulAdd(t[0], g[0], B(t[1] * g[1])), z = mulAdd(t[0], g[1], B(t[1] * g[2]));
  out[0] = mulAdd(t[0], x, B(t[1] * z));
  out[1] = t[2] * z;
  out[2] = t[2] * t[2] * g[2];
}

/// By how much the products of two vectors change: e.e, e.d, d.d.
template <class B>
[[gnu::always_inline]] inline void metricChange(const B (&e)[3], const B (&d)[3], const B (&ue)[3], const B (&ud)[3],
                                                B (&change)[3]) {
  const B half = constant<B>(0.5), two = constant<B>(2);
  B sum_e[3], sum_d[3];
  for (int r = 0; r < 3; ++r) sum_e[r] = mulAdd(two, e[r], ue[r]), sum_d[r] = mulAdd(two, d[r], ud[r]);
  change[0] = dot(ue, sum_e);
  change[1] = half * (dot(ue, sum_d) + dot(sum_e, ud));
  change[2] = dot(ud, sum_d);
}

/// The strain S = C - 1 at the midpoint of a side.
template <class B>
[[gnu::always_inline]] inline void sideStrain(const B (&t)[3], const B (&e)[3], const B (&d)[3], const B (&ue)[3],
                                              const B (&ud)[3], B (&s)[3]) {
  B change[3];
  metricChange(e, d, ue, ud, change);
  pullBack(t, change, s);
}

/// Active strain: the muscle has shortened to 1 / (1 + contraction) along a unit direction of the wall, which has
/// become thicker by as much. The elastic metric is then M^T C M with M M^T = 1 + ((1 + contraction)^2 - 1) c c^T, M
/// upper triangular.
/// @param c, n   the direction in the basis of T
/// @param t      in: T; out: T M
/// @param grown  out: M^T M - 1, the strain that this adds
template <class B>
[[gnu::always_inline]] inline void shorten(const B& contraction, const B& c, const B& n, B (&t)[3], B (&grown)[3]) {
  const B one = constant<B>(1), more = contraction * (constant<B>(2) + contraction), across = more * n * n;
  const B m22 = rootOf(B(one + across)), inverse = one / m22;
  const B m11 = (one + contraction) * inverse, m12 = more * c * n * inverse;
  grown[0] = mulAdd(m11, m11, B(-one));
  grown[1] = m11 * m12;
  grown[2] = mulAdd(m12, m12, across);
  t[1] = mulAdd(t[0], m12, B(t[1] * m22));
  t[0] = t[0] * m11;
  t[2] = t[2] * m22;
}

/// Twice the membrane energy at the midpoint of a side, and the stress there: its components along e and d, ee, ed, dd,
/// times the volume of the side. They are the same in every frame.
/// @tparam rows   of the triangle
/// @param e, d    the side, and the vector from the opposite node to the apex beyond it; at rest
/// @param ue, ud  their displacements
template <Law law, int Steps, int rows, class B, class Rest>
[[gnu::always_inline]] inline B sideStress(const WallTerms<B>& terms, const Rest& rest, const B& contraction, int side,
                                           const B (&e)[3], const B (&d)[3], const B (&ue)[3], const B (&ud)[3],
                                           B (&a)[3]) {
  const int row = kShellSide + 4 * side;
  B t[3] = {rest(row), rest(row + 1), rest(row + 2)}, s[3];
  if constexpr (rows == kShellMuscleRows) {
    B grown[3];
    shorten(contraction, rest(kShellMuscle + 2 * side), rest(kShellMuscle + 2 * side + 1), t, grown);
    sideStrain(t, e, d, ue, ud, s);
    for (int k = 0; k < 3; ++k) s[k] = s[k] + grown[k];
  } else {
    sideStrain(t, e, d, ue, ud, s);
  }
  const PlaneStress<B> p = planeStress<law, Steps>(terms, B(s[0] + s[2]), minor(s[0], s[2], s[1], s[1]));
  // dW/dC = W_I (1 - y^2 cof C), cof C = 1 + cof S
  const B volume = rest(row + 3), w = p.by_i * volume, square = w * p.square, shear = w + square;
  const B g[3] = {-mulAdd(shear, s[2], square), shear * s[1], -mulAdd(shear, s[0], square)};
  pushForward(t, g, a);
  return volume * p.energy;
}

/// The forces of a stress as sideStress() gives it: the derivatives of the energy with respect to e and d.
template <class B>
[[gnu::always_inline]] inline void stressForces(const B (&a)[3], const B (&e)[3], const B (&d)[3], const B (&ue)[3],
                                                const B (&ud)[3], B (&fe)[3], B (&fd)[3]) {
  for (int r = 0; r < 3; ++r) {
    const B now_e = e[r] + ue[r], now_d = d[r] + ud[r];
    fe[r] = mulAdd(a[0], now_e, B(a[1] * now_d));
    fd[r] = mulAdd(a[1], now_e, B(a[2] * now_d));
  }
}

/// Twice the work of a constant stress from rest to here.
template <class B>
[[gnu::always_inline]] inline B stressWork(const B (&a)[3], const B (&e)[3], const B (&d)[3], const B (&ue)[3],
                                           const B (&ud)[3]) {
  B change[3];
  metricChange(e, d, ue, ud, change);
  return mulAdd(a[0], change[0], B(mulAdd(B(constant<B>(2) * a[1]), change[1], B(a[2] * change[2]))));
}

/// No stress beside that of the law; others have their numbers by row, kStressRows of them.
template <class B>
struct NoStress {
  constexpr bool given() const { return false; }
  B operator()(int /*row*/) const { return constant<B>(0); }
};

/// Twice the membrane energy at the midpoint of a side, and the derivatives of the energy, see sideStress().
/// @param beside      a constant stress that acts as well
/// @param twice_work  of that, added to
template <Law law, int Steps, int rows, class B, class Rest, class Stress>
[[gnu::always_inline]] inline B sideEnergy(const WallTerms<B>& terms, const Rest& rest, const B& contraction,
                                           const Stress& beside, int side, const B (&e)[3], const B (&d)[3],
                                           const B (&ue)[3], const B (&ud)[3], B (&fe)[3], B (&fd)[3], B& twice_work) {
  B a[3];
  const B twice = sideStress<law, Steps, rows>(terms, rest, contraction, side, e, d, ue, ud, a);
  if (beside.given()) {
    const B more[3] = {beside(3 * side), beside(3 * side + 1), beside(3 * side + 2)};
    twice_work = twice_work + stressWork(more, e, d, ue, ud);
    for (int c = 0; c < 3; ++c) a[c] = a[c] + more[c];
  }
  stressForces(a, e, d, ue, ud, fe, fd);
  return twice;
}

/// Nodes 2 and 3 and the apexes, each relative to node 1.
template <class B>
using Patch = B[5][3];

/// The sum over the three sides of a function like sideEnergy; adds its gradients to f.
template <class Side, class B>
[[gnu::always_inline]] inline B overSides(const Side& side_energy, const Patch<B>& x, const Patch<B>& u, Patch<B>& f) {
  B energy = constant<B>(0), e[3], d[3], ue[3], ud[3], fe[3], fd[3];
  for (int r = 0; r < 3; ++r) {
    e[r] = x[1][r] - x[0][r], d[r] = x[2][r];
    ue[r] = u[1][r] - u[0][r], ud[r] = u[2][r];
  }
  energy = energy + side_energy(0, e, d, ue, ud, fe, fd);
  for (int r = 0; r < 3; ++r) f[0][r] = f[0][r] - fe[r], f[1][r] = f[1][r] + fe[r], f[2][r] = f[2][r] + fd[r];
  for (int r = 0; r < 3; ++r) d[r] = x[0][r] - x[3][r], ud[r] = u[0][r] - u[3][r];
  energy = energy + side_energy(1, x[1], d, u[1], ud, fe, fd);
  for (int r = 0; r < 3; ++r) f[1][r] = f[1][r] + fe[r], f[0][r] = f[0][r] + fd[r], f[3][r] = f[3][r] - fd[r];
  for (int r = 0; r < 3; ++r) d[r] = x[1][r] - x[4][r], ud[r] = u[1][r] - u[4][r];
  energy = energy + side_energy(2, x[0], d, u[0], ud, fe, fd);
  for (int r = 0; r < 3; ++r) f[0][r] = f[0][r] + fe[r], f[1][r] = f[1][r] + fd[r], f[4][r] = f[4][r] - fd[r];
  return energy;
}

/// Adds the membrane gradient to f; returns twice the energy.
/// @param beside, twice_work  see sideEnergy()
template <Law law, int Steps, int rows, class B, class Rest, class Stress>
[[gnu::always_inline]] inline B membraneEnergy(const WallTerms<B>& terms, const Rest& rest, const B& contraction,
                                               const Stress& beside, const Patch<B>& x, const Patch<B>& u, Patch<B>& f,
                                               B& twice_work) {
  const auto side = [&](int k, const B(&e)[3], const B(&d)[3], const B(&ue)[3], const B(&ud)[3], B(&fe)[3], B(&fd)[3])
      __attribute__((always_inline)) {
    return sideEnergy<law, Steps, rows>(terms, rest, contraction, beside, k, e, d, ue, ud, fe, fd, twice_work);
  };
  return overSides(side, x, u, f);
}

}  // namespace
}  // namespace vibe
