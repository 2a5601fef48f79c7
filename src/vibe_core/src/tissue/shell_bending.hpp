#pragma once

#include "tissue/shell_membrane.hpp"

// The bending energy of one triangle of a shell, its moments and its gradient; as in shell_membrane.hpp.

namespace vibe {
namespace {

// Square of the fraction of the rest area element that is added to the area element, so that the normal n = c /
// sqrt(c.c + softness) has a derivative where the area c vanishes. It reduces the bending stiffness of a flat wall by
// the same amount.
constexpr double kShellSoftness = 1e-5;
// 1 / (squared stretch of the area) enters the bending stiffness unchanged up to the first value, and is then limited
// smoothly to 6.
constexpr double kThinningStart = 2, kThinningEnd = 6;

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
/// @param beside  a constant stress that acts as well
/// @param work    of its moments from rest to here, added to
template <class B, class Rest, class Stress>
[[gnu::always_inline]] inline B bendingEnergy(const WallTerms<B>& terms, const Rest& rest, const Stress& beside,
                                              const Patch<B>& x, const Patch<B>& u, Patch<B>& f, B& work) {
  const B two = constant<B>(2);
  const Bent<B> s = bentSurface(rest, x, u);
  const Moments<B> bent = momentsOf(terms, rest, s);
  const BendingFactor<B>& factor = bent.factor;
  const B by_thin =
      mulAdd(rest(kShellBend) * factor.by_thin, bent.form, B(bent.whole * factor.mean_by_thin * bent.square));
  // half the derivative with respect to c.c
  const B widen = -mulAdd(B(by_thin * s.thin), B(s.inverse * s.inverse), B(bent.whole * bent.gauss));
  B m[3] = {bent.m[0], bent.m[1], bent.m[2]}, p[3], pull0[3], pull1[3];
  if (beside.given())
    for (int c = 0; c < 3; ++c) {
      const B more = beside(9 + c);
      work = mulAdd(more, s.change[c], work);
      m[c] = m[c] + more;
    }
  turningOf(s, m, p);
  for (int r = 0; r < 3; ++r) p[r] = mulAdd(B(two * widen), s.c[r], p[r]);
  cross(s.g[1], p, pull0);
  cross(p, s.g[0], pull1);
  const B* k = s.change;
  const B by0 = two * bent.pull * k[2], by1 = -two * bent.pull * k[1], by2 = two * bent.pull * k[0];
  for (int r = 0; r < 3; ++r) {
    pull0[r] = mulAdd(by0, s.g[0][r], B(mulAdd(by1, s.g[1][r], pull0[r])));
    pull1[r] = mulAdd(by2, s.g[1][r], B(mulAdd(by1, s.g[0][r], pull1[r])));
  }
  addMomentForces(m, s.n, pull0, pull1, f);
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

}  // namespace
}  // namespace vibe
