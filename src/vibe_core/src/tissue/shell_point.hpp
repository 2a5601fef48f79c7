#pragma once

#include "tissue/shell_kernel.hpp"
#include "tissue/shell_plane_stress.hpp"

// The energy of one triangle of a shell and its gradient, for one triangle or a pack of them; law_terms.hpp explains
// why everything is in an unnamed namespace.

namespace vibe {
namespace {

// Square of the fraction of the rest area element that is added to the area element, so that the normal n = c /
// sqrt(c.c + softness) has a derivative where the area c vanishes. It reduces the bending stiffness of a flat wall by
// the same amount.
constexpr double kShellSoftness = 1e-5;
// 1 / (squared stretch of the area) enters the bending stiffness unchanged up to the first value, and is then limited
// smoothly to 6.
constexpr double kThinningStart = 2, kThinningEnd = 6;

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

/// Twice the membrane energy at the midpoint of a side, and the derivatives of the energy, see sideStress().
template <Law law, int Steps, int rows, class B, class Rest>
[[gnu::always_inline]] inline B sideEnergy(const WallTerms<B>& terms, const Rest& rest, const B& contraction, int side,
                                           const B (&e)[3], const B (&d)[3], const B (&ue)[3], const B (&ud)[3],
                                           B (&fe)[3], B (&fd)[3]) {
  B a[3];
  const B twice = sideStress<law, Steps, rows>(terms, rest, contraction, side, e, d, ue, ud, a);
  stressForces(a, e, d, ue, ud, fe, fd);
  return twice;
}

/// Twice the work of a constant stress from rest to here, and the derivatives of the work with respect to e and d.
template <class B>
[[gnu::always_inline]] inline B stressWork(const B (&a)[3], const B (&e)[3], const B (&d)[3], const B (&ue)[3],
                                           const B (&ud)[3], B (&fe)[3], B (&fd)[3]) {
  B change[3];
  metricChange(e, d, ue, ud, change);
  stressForces(a, e, d, ue, ud, fe, fd);
  return mulAdd(a[0], change[0], B(mulAdd(B(constant<B>(2) * a[1]), change[1], B(a[2] * change[2]))));
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
template <Law law, int Steps, int rows, class B, class Rest>
[[gnu::always_inline]] inline B membraneEnergy(const WallTerms<B>& terms, const Rest& rest, const B& contraction,
                                               const Patch<B>& x, const Patch<B>& u, Patch<B>& f) {
  const auto side = [&](int k, const B(&e)[3], const B(&d)[3], const B(&ue)[3], const B(&ud)[3], B(&fe)[3], B(&fd)[3])
      __attribute__((always_inline)) {
    return sideEnergy<law, Steps, rows>(terms, rest, contraction, k, e, d, ue, ud, fe, fd);
  };
  return overSides(side, x, u, f);
}

/// Six times the tangents of the surface at the centroid, with respect to the two coordinates.
template <class B>
[[gnu::always_inline]] inline void tangents(const Patch<B>& x, B (&first)[3], B (&second)[3]) {
  const B four = constant<B>(4);
  for (int r = 0; r < 3; ++r) {
    first[r] = mulAdd(four, x[0][r], B(x[2][r] - x[3][r]));
    second[r] = mulAdd(four, x[1][r], B(x[2][r] - x[4][r]));
  }
}

/// Second derivatives of the surface with respect to the coordinates: 11, 12, 22.
template <class B>
[[gnu::always_inline]] inline void secondDerivatives(const Patch<B>& x, B (&h)[3][3]) {
  const B two = constant<B>(2);
  for (int r = 0; r < 3; ++r) {
    h[0][r] = minusMul(two, x[1][r], B(x[2][r] + x[3][r]));
    h[1][r] = x[2][r] - (x[0][r] + x[1][r]);
    h[2][r] = minusMul(two, x[0][r], B(x[2][r] + x[4][r]));
  }
}

/// The bent surface: b - B without cancellation, and the quantities for its derivative.
template <class B>
struct Bent {
  B g[2][3];       ///< tangents
  B c[3];          ///< g0 x g1
  B square;        ///< c.c
  B n[3];          ///< normal
  B inverse;       ///< 1 / length of c = g0 x g1
  B thin;          ///< (length at rest / length)^2
  B rest_h[3][3];  ///< second derivatives at rest
  B move_h[3][3];  ///< their displacement
  B change[3];     ///< b - B: 11, 12, 22
};

template <class B, class Rest>
[[gnu::always_inline]] inline Bent<B> bentSurface(const Rest& rest, const Patch<B>& x, const Patch<B>& u) {
  Bent<B> out;
  B g0[3], g1[3], u0[3], u1[3], part[3], more[3];
  tangents(x, g0, g1);
  tangents(u, u0, u1);
  for (int r = 0; r < 3; ++r) out.g[0][r] = g0[r] + u0[r], out.g[1][r] = g1[r] + u1[r];
  cross(g0, u1, part);
  cross(u0, out.g[1], more);
  const B normal[3] = {rest(kShellNormal), rest(kShellNormal + 1), rest(kShellNormal + 2)}, length = rest(kShellLength);
  B both[3];
  for (int r = 0; r < 3; ++r) {
    more[r] = part[r] + more[r];
    out.c[r] = mulAdd(length, normal[r], more[r]);
    both[r] = mulAdd(length, normal[r], out.c[r]);
  }
  out.square = dot(out.c, out.c);
  const B now = rootOf(B(mulAdd(B(constant<B>(kShellSoftness) * length), length, out.square)));
  const B reach = now + length, both_inverse = constant<B>(1) / (now * reach);
  out.inverse = both_inverse * reach;
  const B ratio = length * out.inverse, longer = dot(more, both) * (both_inverse * now);
  out.thin = ratio * ratio;
  B turn[3];
  for (int r = 0; r < 3; ++r) {
    out.n[r] = out.c[r] * out.inverse;
    turn[r] = minusMul(longer, normal[r], more[r]) * out.inverse;
  }
  secondDerivatives(x, out.rest_h);
  secondDerivatives(u, out.move_h);
  for (int k = 0; k < 3; ++k) out.change[k] = dot(out.n, out.move_h[k]) + dot(turn, out.rest_h[k]);
  return out;
}

/// Dependence of the bending energy on the squared stretch of the area, D.
template <class B>
struct BendingFactor {
  B whole,
      by_thin;  ///< 1 / D^2 times c, the squared stretch across the wall; its derivative with respect to thin = 1 / D
  B mean, mean_by_thin;  ///< weight of the mean curvature, 1 at rest
};

/// The second derivative of the neo-Hookean plane-stress energy mu/2 tr C + f(D) at the stretched metric. With f' =
/// -mu/2 c/D and f'' = mu/2 c/D^2 R, R = (2 mu c + 2 lambda) / (2 mu c + lambda), a strain that is linear across the
/// wall has the energy (R h^2 - 2 g) mu c, where h and g are the sum and the product of the two curvatures. c(D) is
/// approximated by the rational function and R(c) by the straight line with the correct value and slope at rest (for nu
/// = 0.45 the error of c is 1 % at D = 4, 5 % at D = 1/4).
template <class B>
[[gnu::always_inline]] inline BendingFactor<B> bendingFactor(const WallTerms<B>& terms, const B& thin) {
  const B start = constant<B>(kThinningStart), end = constant<B>(kThinningEnd), one = constant<B>(1);
  const B kept = smaller(thin, end), over = larger(B(kept - start), constant<B>(0));
  const B bend = over * constant<B>(0.5 / (kThinningEnd - kThinningStart));
  const B tau = minusMul(bend, over, kept), slope = minusMul(constant<B>(2), bend, one);
  const B s = larger(terms.thickness_guess, constant<B>(0));
  const B inverse = one / mulAdd(one - s, tau, s), across = tau * inverse, by = s * inverse * inverse * slope;
  const B square = tau * tau;
  BendingFactor<B> out;
  out.whole = square * across;
  out.by_thin = mulAdd(square, by, constant<B>(2) * tau * across * slope);
  out.mean = minusMul(terms.mean_softening, across - one, one);
  out.mean_by_thin = -terms.mean_softening * by;
  return out;
}

/// The bending energy and its derivatives with respect to the change of curvature: 11, 12 and 21, 22.
template <class B>
struct Moments {
  BendingFactor<B> factor;
  B a[3];  ///< metric
  B mean, square, gauss, whole, form, pull, twist;
  B m[3];
  B energy() const { return whole * form; }
};

/// With the metric a and the change k of the curvature at the centroid the energy is (mean (cof a : k)^2 - 2 (1 - nu)
/// det a det k) whole, a polynomial in a and k that is never negative.
template <class B, class Rest>
[[gnu::always_inline]] inline Moments<B> momentsOf(const WallTerms<B>& terms, const Rest& rest, const Bent<B>& s) {
  const B two = constant<B>(2), gauss_share = two - two * terms.poisson_ratio;
  Moments<B> out;
  out.a[0] = dot(s.g[0], s.g[0]), out.a[1] = dot(s.g[0], s.g[1]), out.a[2] = dot(s.g[1], s.g[1]);
  out.factor = bendingFactor(terms, s.thin);
  const B *a = out.a, *k = s.change;
  out.mean = mulAdd(a[2], k[0], B(minusMul(B(two * a[1]), k[1], B(a[0] * k[2]))));
  out.gauss = gauss_share * minor(k[0], k[2], k[1], k[1]), out.whole = rest(kShellBend) * out.factor.whole;
  out.square = out.mean * out.mean;
  out.form = minusMul(s.square, out.gauss, B(out.factor.mean * out.square));
  out.pull = two * out.whole * out.factor.mean * out.mean, out.twist = out.whole * gauss_share * s.square;
  out.m[0] = minusMul(out.twist, k[2], B(out.pull * a[2]));
  out.m[1] = two * minusMul(out.pull, a[1], B(out.twist * k[1]));
  out.m[2] = minusMul(out.twist, k[0], B(out.pull * a[0]));
  return out;
}

/// How moments turn the normal: their derivative with respect to the area vector.
template <class B>
[[gnu::always_inline]] inline void turningOf(const Bent<B>& s, const B (&m)[3], B (&p)[3]) {
  B q[3];
  for (int r = 0; r < 3; ++r) {
    const B h0 = s.rest_h[0][r] + s.move_h[0][r], h1 = s.rest_h[1][r] + s.move_h[1][r];
    q[r] = mulAdd(m[0], h0, B(mulAdd(m[1], h1, B(m[2] * (s.rest_h[2][r] + s.move_h[2][r])))));
  }
  const B along = dot(s.n, q);
  for (int r = 0; r < 3; ++r) p[r] = s.inverse * minusMul(along, s.n[r], q[r]);
}

/// Adds the forces of moments and of pulls on the tangents to f.
template <class B>
[[gnu::always_inline]] inline void addMomentForces(const B (&m)[3], const B (&n)[3], const B (&pull0)[3],
                                                   const B (&pull1)[3], Patch<B>& f) {
  const B two = constant<B>(2), four = constant<B>(4);
  const B second = mulAdd(two, m[2], m[1]), third = mulAdd(two, m[0], m[1]), all = m[0] + m[1] + m[2];
  for (int r = 0; r < 3; ++r) {
    f[0][r] = minusMul(second, n[r], B(mulAdd(four, pull0[r], f[0][r])));
    f[1][r] = minusMul(third, n[r], B(mulAdd(four, pull1[r], f[1][r])));
    f[2][r] = mulAdd(all, n[r], B(f[2][r] + (pull0[r] + pull1[r])));
    f[3][r] = mulAdd(m[0], n[r], B(f[3][r] - pull0[r]));
    f[4][r] = mulAdd(m[2], n[r], B(f[4][r] - pull1[r]));
  }
}

/// Adds the gradient to f; returns the energy.
template <class B, class Rest>
[[gnu::always_inline]] inline B bendingEnergy(const WallTerms<B>& terms, const Rest& rest, const Patch<B>& x,
                                              const Patch<B>& u, Patch<B>& f) {
  const B two = constant<B>(2);
  const Bent<B> s = bentSurface(rest, x, u);
  const Moments<B> bent = momentsOf(terms, rest, s);
  const BendingFactor<B>& factor = bent.factor;
  const B by_thin =
      mulAdd(rest(kShellBend) * factor.by_thin, bent.form, B(bent.whole * factor.mean_by_thin * bent.square));
  // half the derivative with respect to c.c
  const B widen = -mulAdd(B(by_thin * s.thin), B(s.inverse * s.inverse), B(bent.whole * bent.gauss));
  B p[3], pull0[3], pull1[3];
  turningOf(s, bent.m, p);
  for (int r = 0; r < 3; ++r) p[r] = mulAdd(B(two * widen), s.c[r], p[r]);
  cross(s.g[1], p, pull0);
  cross(p, s.g[0], pull1);
  const B* k = s.change;
  const B by0 = two * bent.pull * k[2], by1 = -two * bent.pull * k[1], by2 = two * bent.pull * k[0];
  for (int r = 0; r < 3; ++r) {
    pull0[r] = mulAdd(by0, s.g[0][r], B(mulAdd(by1, s.g[1][r], pull0[r])));
    pull1[r] = mulAdd(by2, s.g[1][r], B(mulAdd(by1, s.g[0][r], pull1[r])));
  }
  addMomentForces(bent.m, s.n, pull0, pull1, f);
  return bent.energy();
}

/// The work of constant moments from rest to here; adds its gradient to f.
template <class B, class Rest>
[[gnu::always_inline]] inline B momentWork(const B (&m)[3], const Rest& rest, const Patch<B>& x, const Patch<B>& u,
                                           Patch<B>& f) {
  const Bent<B> s = bentSurface(rest, x, u);
  B p[3], pull0[3], pull1[3];
  turningOf(s, m, p);
  cross(s.g[1], p, pull0);
  cross(p, s.g[0], pull1);
  addMomentForces(m, s.n, pull0, pull1, f);
  return mulAdd(m[0], s.change[0], B(mulAdd(m[1], s.change[1], B(m[2] * s.change[2]))));
}

/// The end nodes of a side, and the node opposite it; 0 is node 1.
constexpr int kBeside[3][2] = {{1, 2}, {2, 0}, {0, 1}};

/// Places the ghosts of sides without a neighbour: the opposite node is reflected at the midpoint of the side. The
/// metric of the membrane there is that of the triangle itself.
template <class B, class Rest>
[[gnu::always_inline]] inline void placeGhosts(const Rest& rest, Patch<B>& u) {
  const B one = constant<B>(1), zero = constant<B>(0);
  for (int side = 0; side < 3; ++side) {
    const int p = kBeside[side][0], q = kBeside[side][1];
    const B real = rest(kShellGhost + 4 * side);
    for (int r = 0; r < 3; ++r) {
      const B sum = (p == 0 ? zero : u[p - 1][r]) + (q == 0 ? zero : u[q - 1][r]);
      const B ghost = sum - (side == 0 ? zero : u[side - 1][r]);
      u[side + 2][r] = mulAdd(real, u[side + 2][r], B((one - real) * ghost));
    }
  }
}

/// For bending, moves the ghosts across clamped sides along the normal, like the opposite node: the tangent plane
/// stays. The membrane does not see this: a mesh that does not resolve how the slope grows from 0 would lose its
/// stretch there.
template <class B, class Rest>
[[gnu::always_inline]] inline void clampGhosts(const Rest& rest, Patch<B>& u) {
  const B half = constant<B>(0.5), zero = constant<B>(0);
  for (int side = 0; side < 3; ++side) {
    const int row = kShellGhost + 4 * side, p = kBeside[side][0], q = kBeside[side][1];
    const B m[3] = {rest(row + 1), rest(row + 2), rest(row + 3)};
    B arm[3];
    for (int r = 0; r < 3; ++r) {
      const B sum = (p == 0 ? zero : u[p - 1][r]) + (q == 0 ? zero : u[q - 1][r]);
      arm[r] = (side == 0 ? zero : u[side - 1][r]) - half * sum;
    }
    const B along = dot(m, arm);
    for (int r = 0; r < 3; ++r) u[side + 2][r] = mulAdd(m[r], along, u[side + 2][r]);
  }
}

/// The transpose of clampGhosts.
template <class B, class Rest>
[[gnu::always_inline]] inline void returnClamped(const Rest& rest, Patch<B>& f) {
  const B half = constant<B>(0.5);
  for (int side = 0; side < 3; ++side) {
    const int row = kShellGhost + 4 * side, p = kBeside[side][0], q = kBeside[side][1];
    const B m[3] = {rest(row + 1), rest(row + 2), rest(row + 3)};
    const B along = dot(m, f[side + 2]);
    for (int r = 0; r < 3; ++r) {
      const B beside = B(half * along) * m[r];
      if (p != 0) f[p - 1][r] = f[p - 1][r] - beside;
      if (q != 0) f[q - 1][r] = f[q - 1][r] - beside;
      if (side != 0) f[side - 1][r] = mulAdd(along, m[r], f[side - 1][r]);
    }
  }
}

/// The transpose of placeGhosts.
template <class B, class Rest>
[[gnu::always_inline]] inline void returnGhosts(const Rest& rest, Patch<B>& f) {
  for (int side = 0; side < 3; ++side) {
    const int p = kBeside[side][0], q = kBeside[side][1];
    const B real = rest(kShellGhost + 4 * side);
    for (int r = 0; r < 3; ++r) {
      const B own = real * f[side + 2][r], ghost = f[side + 2][r] - own;
      f[side + 2][r] = own;
      if (p != 0) f[p - 1][r] = f[p - 1][r] + ghost;
      if (q != 0) f[q - 1][r] = f[q - 1][r] + ghost;
      if (side != 0) f[side - 1][r] = f[side - 1][r] - ghost;
    }
  }
}

/// Half of what `membrane` returns and what `bending` returns. Both have x, u and f as arguments and add a gradient to
/// f.
/// @param u  with ghosts as placeGhosts leaves them
template <bool ghosts, class B, class Rest, class Membrane, class Bending>
[[gnu::always_inline]] inline B membraneAndBending(const Rest& rest, const Membrane& membrane_part,
                                                   const Bending& bending_part, Patch<B>& u, Patch<B>& f) {
  Patch<B> x;
  for (int a = 0; a < 5; ++a)
    for (int r = 0; r < 3; ++r) x[a][r] = rest(kShellPatch + 3 * a + r), f[a][r] = constant<B>(0);
  const B membrane = membrane_part(x, u, f);
  if constexpr (!ghosts) {
    return mulAdd(constant<B>(0.5), membrane, bending_part(x, u, f));
  } else {
    B kept[3][3];
    for (int side = 0; side < 3; ++side)
      for (int r = 0; r < 3; ++r) kept[side][r] = f[side + 2][r], f[side + 2][r] = constant<B>(0);
    clampGhosts(rest, u);
    const B bending = bending_part(x, u, f);
    returnClamped(rest, f);
    for (int side = 0; side < 3; ++side)
      for (int r = 0; r < 3; ++r) f[side + 2][r] = f[side + 2][r] + kept[side][r];
    return mulAdd(constant<B>(0.5), membrane, bending);
  }
}

/// Energy of a triangle. Its gradient with respect to nodes 2 to 6 is written to f; that of node 1 is minus their sum.
/// @tparam rows        of the triangle
/// @param contraction  of its muscle, see shorten(); unused without
/// @param u            with ghosts as placeGhosts leaves them
template <Law law, int Steps, int rows, class B, class Rest>
[[gnu::always_inline]] inline B shellEnergy(const WallTerms<B>& terms, const Rest& rest, const B& contraction,
                                            Patch<B>& u, Patch<B>& f) {
  const auto membrane = [&](const Patch<B>& x, const Patch<B>& at, Patch<B>& to) __attribute__((always_inline)) {
    return membraneEnergy<law, Steps, rows>(terms, rest, contraction, x, at, to);
  };
  const auto bending = [&](const Patch<B>& x, const Patch<B>& at, Patch<B>& to) __attribute__((always_inline)) {
    return bendingEnergy(terms, rest, x, at, to);
  };
  return membraneAndBending<rows == kShellGhostRows>(rest, membrane, bending, u, f);
}

/// The energy of a triangle; `out` takes its stress and its moments, kStressRows numbers in order.
template <Law law, int Steps, int rows, class B, class Rest>
[[gnu::always_inline]] inline B shellStress(const WallTerms<B>& terms, const Rest& rest, const B& contraction,
                                            Patch<B>& u, B (&out)[kStressRows]) {
  const auto membrane = [&](const Patch<B>& x, const Patch<B>& at, Patch<B>& to) __attribute__((always_inline)) {
    const auto side = [&](int k, const B(&e)[3], const B(&d)[3], const B(&ue)[3], const B(&ud)[3], B(&fe)[3], B(&fd)[3])
        __attribute__((always_inline)) {
      B a[3];
      const B twice = sideStress<law, Steps, rows>(terms, rest, contraction, k, e, d, ue, ud, a);
      for (int c = 0; c < 3; ++c) out[3 * k + c] = a[c];
      for (int r = 0; r < 3; ++r) fe[r] = fd[r] = constant<B>(0);
      return twice;
    };
    return overSides(side, x, at, to);
  };
  const auto bending = [&](const Patch<B>& x, const Patch<B>& at, Patch<B>&) __attribute__((always_inline)) {
    const Moments<B> bent = momentsOf(terms, rest, bentSurface(rest, x, at));
    for (int c = 0; c < 3; ++c) out[9 + c] = bent.m[c];
    return bent.energy();
  };
  Patch<B> unused;
  return membraneAndBending<rows == kShellGhostRows>(rest, membrane, bending, u, unused);
}

/// The work of a stress that shellStress() has given, from rest to here; its gradient is written to f.
/// @param stress  a number of it, by its row
template <bool ghosts, class B, class Rest, class Stress>
[[gnu::always_inline]] inline B shellStressWork(const Rest& rest, const Stress& stress, Patch<B>& u, Patch<B>& f) {
  const auto membrane = [&](const Patch<B>& x, const Patch<B>& at, Patch<B>& to) __attribute__((always_inline)) {
    const auto side = [&](int k, const B(&e)[3], const B(&d)[3], const B(&ue)[3], const B(&ud)[3], B(&fe)[3], B(&fd)[3])
        __attribute__((always_inline)) {
      const B a[3] = {stress(3 * k), stress(3 * k + 1), stress(3 * k + 2)};
      return stressWork(a, e, d, ue, ud, fe, fd);
    };
    return overSides(side, x, at, to);
  };
  const auto bending = [&](const Patch<B>& x, const Patch<B>& at, Patch<B>& to) __attribute__((always_inline)) {
    const B m[3] = {stress(9), stress(10), stress(11)};
    return momentWork(m, rest, x, at, to);
  };
  return membraneAndBending<ghosts>(rest, membrane, bending, u, f);
}

/// A third of the area vector of a triangle (a sixth of the cross product), the share of each node; returns the volume
/// of the cone to the origin.
template <class B, class Rest>
[[gnu::always_inline]] inline B coneVolume(const Rest& rest, const Patch<B>& u, const B (&u1)[3], B (&share)[3]) {
  const B sixth = constant<B>(1.0 / 6);
  B e[3], d[3], at[3];
  for (int r = 0; r < 3; ++r) {
    e[r] = rest(kShellPatch + r) + u[0][r], d[r] = rest(kShellPatch + 3 + r) + u[1][r];
    at[r] = rest(kShellOrigin + r) + u1[r];
  }
  cross(e, d, share);
  for (int r = 0; r < 3; ++r) share[r] = sixth * share[r];
  return dot(at, share);
}

}  // namespace
}  // namespace vibe
