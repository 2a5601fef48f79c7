#pragma once

#include <type_traits>

#include "arithmetic/elementary.hpp"
#include "tissue/material_law.hpp"

// The laws of a solid applied to a wall with zero stress across it, for one wall or a pack of them; law_terms.hpp
// explains why everything is in an unnamed namespace.

namespace vibe {
namespace {

// Lower bound of the derivative of the stress across the wall with respect to its stretch, in shear moduli; it is 1 or
// more at rest.
constexpr double kMinSlope = 0.01;
constexpr int kRareSteps = 7;  // of Newton's method in rare states, where speed does not matter

/// a b - c d
template <class B>
inline B minor(const B& a, const B& b, const B& c, const B& d) {
  return minusMul(c, d, B(a * b));
}

inline double rootOf(double x) {
  return std::sqrt(x);
}
template <class A>
inline xsimd::batch<float, A> rootOf(const xsimd::batch<float, A>& x) {
  return xsimd::sqrt(x);
}

/// A material of a shell in all lanes.
template <class B>
struct WallTerms {
  LawTerms<B> law;
  B poisson_ratio, thickness_guess, quarter_bulk;  // nu, nu / (1 - nu), lambda / 4
  B mean_softening;

  WallTerms(const LawConstants& constants, double nu)
      : law(constants),
        poisson_ratio(constant<B>(nu)),
        thickness_guess(constant<B>(nu / (1 - nu))),
        quarter_bulk(constant<B>(constants.bulk / 4)),
        mean_softening(constant<B>(nu > 0 ? nu * (1 - 2 * nu) / (1 - nu) : 0)) {}
};

/// Energy per volume at rest in plane stress [Pa].
template <class B>
struct PlaneStress {
  B energy;
  B by_i;    ///< W_I
  B square;  ///< y^2 - 1 for the squared stretch D y^2 across the wall
};

/// One evaluation for Newton's method for eta, see planeStress.
template <class B>
struct ThicknessStep {
  LawAt<B> w;
  B change, residual, slope;
};

template <Law law, class B>
[[gnu::always_inline]] inline ThicknessStep<B> thicknessStep(const LawTerms<B>& c, const B& area, const B& more,
                                                             const B& minor_strain, const B& eta) {
  const B two = constant<B>(2), four = constant<B>(4), one = constant<B>(1);
  const B j = mulAdd(area, eta, more), even = mulAdd(B(area * eta), eta, B(-minor_strain));
  ThicknessStep<B> out;
  out.w = lawAt<law>(c, B(mulAdd(two, j, even)), j, even);
  const LawAt<B>& w = out.w;
  const B y = one + eta, pull = two * w.by_i;
  const B curve = mulAdd(B(four * y), B(mulAdd(y, w.by_ii, w.by_ij)), w.by_jj);
  out.residual = mulAdd(pull, eta, w.balance);
  out.slope = larger(B(mulAdd(area, curve, pull)), B(constant<B>(kMinSlope) * c.shear));
  const B step = -out.residual / out.slope;
  out.change = smaller(B(four * y), larger(B(constant<B>(-0.8) * y), step));
  return out;
}

/// The law with the stretch across the wall for which the stress across it vanishes. With the metric C = 1 + S, D = det
/// C, the squared stretch across is written D y^2, so J = D y. Then dW/dy = D (2 W_I y + W_J) has no singularity for D
/// = 0, and the stress follows from dW/dC = W_I (1 - y^2 cof C) alone. Everything is computed from small differences
/// from rest: I - 3 - 2 (J - 1) = D (y - 1)^2 - det S. The last Newton step is not followed by an evaluation: energy
/// and W_I come from their expansions.
template <Law law, int Steps, class B>
[[gnu::noinline]] PlaneStress<B> planeStressOfAny(const WallTerms<B>& terms, const B& more, const B& minor_strain) {
  const B one = constant<B>(1), two = constant<B>(2), area = one + more;
  const B guess = larger(B(area * mulAdd(terms.thickness_guess, more, one)), constant<B>(1e-5));
  B eta = one / rootOf(guess) - one;
  for (int step = 1; step < Steps; ++step)
    eta = eta + thicknessStep<law>(terms.law, area, more, minor_strain, eta).change;
  const ThicknessStep<B> last = thicknessStep<law>(terms.law, area, more, minor_strain, eta);
  const B half_slope = constant<B>(0.5) * last.slope, moved = area * last.change;
  const B by_eta = mulAdd(B(two * (one + eta)), last.w.by_ii, last.w.by_ij), now = eta + last.change;
  return {mulAdd(moved, B(mulAdd(half_slope, last.change, last.residual)), last.w.energy),
          mulAdd(moved, by_eta, last.w.by_i), now * (two + now)};
}

inline bool within(double x, double low, double high) {
  return x > low && x < high;
}
inline bool bothOf(bool a, bool b) {
  return a && b;
}
inline bool allOf(bool condition) {
  return condition;
}
template <class A>
inline xsimd::batch_bool<float, A> within(const xsimd::batch<float, A>& x, double low, double high) {
  using F = xsimd::batch<float, A>;
  return (x > constant<F>(low)) & (x < constant<F>(high));
}
template <class A>
inline xsimd::batch_bool<float, A> bothOf(const xsimd::batch_bool<float, A>& a, const xsimd::batch_bool<float, A>& b) {
  return a & b;
}
template <class A>
inline bool allOf(const xsimd::batch_bool<float, A>& condition) {
  return xsimd::all(condition);
}

/// The laws P(K) + lambda/2 (ln J)^2 are solved for L = 2 ln J within these bounds of D and |L|. There single precision
/// does not overflow, and J is above kLogStart.
constexpr double kPlainAreaLow = 0.1, kPlainAreaHigh = 1e6, kPlainLog = 1.5;
/// A fourth-order step in L may be the last one if it is below this: the remaining error is at most 1e-6 (measured 0.2
/// step^4), and negligible in double precision.
template <Law law, class B>
constexpr double lastStep() {
  return std::is_same_v<B, double> ? 1e-4 : LawFormula<law>::kLastStepOfLog;
}

/// exp(x) - 1 - x without cancellation, |x| <= kPlainLog (relative error 8e-6 there, 2e-7 for |x| <= 1), or what is
/// exact in double precision.
inline double expGap(double x) {
  return std::abs(x) < 0.01 ? x * x * (1.0 / 2 + x * (1.0 / 6 + x * (1.0 / 24 + x * (1.0 / 120 + x / 720))))
                            : math::expm1(x) - x;
}
template <class A>
inline xsimd::batch<float, A> expGap(const xsimd::batch<float, A>& x) {
  using F = xsimd::batch<float, A>;
  const F x2 = x * x;
  const F p01 = mulAdd(F(1.0f / 6), x, F(0.5f)), p23 = mulAdd(F(1.0f / 120), x, F(1.0f / 24));
  const F p45 = mulAdd(F(1.0f / 5040), x, F(1.0f / 720)), p67 = mulAdd(F(1.0f / 362880), x, F(1.0f / 40320));
  return x2 * mulAdd(mulAdd(mulAdd(p67, x2, p45), x2, p23), x2, p01);
}

/// A metric 1 + S, given by the change of its area, the minor and the trace of S.
template <class B>
struct WallMetric {
  B more, minor_strain, trace, inverse_area;
};

/// The law at a given L: energy and its derivative with respect to L; c is the squared stretch across the wall.
template <class B>
struct LogPoint {
  Profile<B> p;
  B across, c, pull;  ///< c - 1, c, lambda/2 ln J

  B residual() const { return mulAdd(p.first, across, pull); }
  B slope(const B& quarter_bulk) const {
    return mulAdd(p.first, c, mulAdd(B(p.second * across), across, quarter_bulk));
  }
};

/// @param gap  exp(L) - 1 - L
template <Law law, class B>
[[gnu::always_inline]] inline LogPoint<B> logPoint(const WallTerms<B>& terms, const WallMetric<B>& m, const B& log,
                                                   const B& gap) {
  LogPoint<B> out;
  const B strain = mulAdd(m.more, B(m.trace - log), B(gap - m.minor_strain));
  out.p = profile<law>(terms.law, B(strain * m.inverse_area));
  out.across = (gap + log - m.more) * m.inverse_area;
  out.c = constant<B>(1) + out.across;
  out.pull = terms.quarter_bulk * log;
  return out;
}

/// Initial guess of L: two terms of the expansion of the root about J = 1, which need no exponential.
template <Law law, class B>
[[gnu::always_inline]] inline B logGuess(const WallTerms<B>& terms, WallMetric<B>& m) {
  const B one = constant<B>(1), half = constant<B>(0.5), zero = constant<B>(0), area = one + m.more;
  B linear, bend;  // -h / h' and h'' / (2 h')
  if constexpr (LawFormula<law>::kConstantSlope) {
    const B first = half * terms.law.shear, scaled = mulAdd(terms.quarter_bulk, area, first);
    const B both = one / (area * scaled), inverse = both * area;  // 1 / (D h')
    m.inverse_area = both * scaled;
    linear = first * m.more * inverse, bend = half * first * inverse;
  } else {
    m.inverse_area = one / area;
    const LogPoint<B> at = logPoint<law>(terms, m, zero, zero);
    const B inverse = one / at.slope(terms.quarter_bulk);
    linear = -at.residual() * inverse;
    bend = half * inverse * mulAdd(constant<B>(3) * at.p.second * at.c, at.across, B(at.p.first * at.c));
  }
  const B bound = constant<B>(kPlainLog - 0.1), y = bend * linear;
  return larger(smaller(B(mulAdd(B(mulAdd(y, y, B(-y))), linear, linear)), bound), B(-bound));
}

/// The same for the laws P(K) + lambda/2 (ln J)^2 if J is not far from 1, solved for L = 2 ln J. With c = exp(L) / D, K
/// = tr S - 1 + c - L, the function h = dW/dL = P' (c - 1) + lambda/4 L is nearly linear. One evaluation of fourth
/// order is sufficient near rest; iterations continue until the steps of all lanes are small. A lane whose step
/// is small stays where it is, so that its bits do not depend on its neighbours, nor on the width of a pack.
/// @param plain  out: where the result is accurate
template <Law law, int Steps, class B, class Mask>
[[gnu::always_inline]] inline PlaneStress<B> planeStressOfLog(const WallTerms<B>& terms, WallMetric<B> m, Mask& plain) {
  const B one = constant<B>(1), half = constant<B>(0.5), sixth = constant<B>(1.0 / 6);
  B log = logGuess<law>(terms, m), z;
  LogPoint<B> at;
  B h, slope, curve;
  for (int step = 0; step < Steps; ++step) {
    if (step > 0)
      log = choose(plain, log, B(larger(smaller(B(log + z), constant<B>(kPlainLog)), constant<B>(-kPlainLog))));
    at = logPoint<law>(terms, m, log, expGap(log));
    h = at.residual(), slope = at.slope(terms.quarter_bulk);
    const B inverse = one / slope, thick = at.p.first * at.c, linear = -h * inverse;
    B twist = thick;
    curve = thick;
    if constexpr (!LawFormula<law>::kConstantSlope) {
      const B bent = constant<B>(3) * at.p.second * at.c;
      const B cubic = at.p.third * at.across * at.across;
      curve = mulAdd(bent, at.across, mulAdd(cubic, at.across, thick));
      twist = mulAdd(bent, at.c + at.across, mulAdd(constant<B>(6) * cubic, at.c, thick));
    }
    const B a = half * curve * inverse, b = sixth * twist * inverse, y = a * linear;
    const B third = mulAdd(y + y, y, -(b * linear) * linear);
    z = larger(smaller(B(mulAdd(B(third - y), linear, linear)), one), B(-one));
    plain = within(z, -lastStep<law, B>(), lastStep<law, B>());
    if (allOf(plain)) break;
  }
  const B growth = z * mulAdd(z, mulAdd(z, sixth, half), one);  // exp(z) - 1
  PlaneStress<B> out;
  out.energy = mulAdd(z, mulAdd(z, B(half * mulAdd(B(constant<B>(1.0 / 3) * z), curve, slope)), h),
                      mulAdd(half * at.pull, log, at.p.value));
  out.by_i = at.p.first;
  if constexpr (!LawFormula<law>::kConstantSlope) {
    const B moved = mulAdd(at.c, growth - z, B(at.across * z));  // of K
    out.by_i = mulAdd(moved, mulAdd(half * moved, at.p.third, at.p.second), at.p.first);
  }
  out.square = (mulAdd(at.c, growth, at.across) - m.more) * m.inverse_area;
  plain = bothOf(plain, bothOf(within(m.more, kPlainAreaLow - 1, kPlainAreaHigh), within(log, -kPlainLog, kPlainLog)));
  return out;
}

/// One evaluation for Newton's method for z = ln c, see planeStressOfNeoHookean.
template <class B>
struct LogStep {
  Profile<B> p;
  B energy, residual;
};

template <Law law, class B>
[[gnu::always_inline]] inline LogStep<B> logStep(const LawTerms<B>& c, const B& more, const B& minor_strain,
                                                 const B& across) {
  const B half = constant<B>(0.5), quarter = constant<B>(0.25);
  const B more_across = more * across, volume = more + across + more_across;  // J^2 - 1
  const B gap = logGap(volume), log = volume - gap;                           // 2 ln J
  LogStep<B> out;
  out.p = profile<law>(c, B(gap - (minor_strain + more_across)));
  const B pull = quarter * c.bulk * log;
  out.energy = mulAdd(B(half * pull), log, out.p.value);
  out.residual = mulAdd(out.p.first, across, pull);
  return out;
}

/// The same for the neo-Hookean law, where P' is constant, solved for z = ln c. One step of fourth order is always
/// sufficient (relative error of the stress 4e-6 for nu = 0.3 and D = 4, less for a larger nu), with one division.
template <class B>
[[gnu::always_inline]] inline PlaneStress<B> planeStressOfNeoHookean(const WallTerms<B>& terms, const B& more,
                                                                     const B& minor_strain) {
  const B one = constant<B>(1), half = constant<B>(0.5), sixth = constant<B>(1.0 / 6);
  const B first = half * terms.law.shear, area = one + more, widening = mulAdd(terms.thickness_guess, more, one);
  const B scaled_slope = mulAdd(terms.quarter_bulk, widening, first), area_widening = area * widening;
  const B all = one / (area_widening * scaled_slope);
  const B both = all * scaled_slope, c = both * area, inverse = all * area_widening * widening;
  const B across = -(terms.thickness_guess * more) * c;
  const LogStep<B> at = logStep<Law::NeoHookean>(terms.law, more, minor_strain, across);
  const B thick = first * c, linear = -at.residual * inverse, bend = thick * inverse;
  const B third = bend * mulAdd(half, bend, B(-sixth));
  const B z = linear * mulAdd(linear, mulAdd(linear, third, B(-half * bend)), one);
  const B curve = mulAdd(B(sixth * z), thick, B(half * (thick + terms.quarter_bulk)));
  const B growth = z * mulAdd(z, mulAdd(z, sixth, half), one);
  return {mulAdd(z, B(mulAdd(curve, z, at.residual)), at.energy), first,
          (mulAdd(c, growth, across) - more) * (both * widening)};
}

/// @param trace, minor_strain  of S
template <Law law, int Steps, class B>
[[gnu::always_inline]] inline PlaneStress<B> planeStress(const WallTerms<B>& terms, const B& trace,
                                                         const B& minor_strain) {
  const B more = trace + minor_strain;
  if constexpr (!LawFormula<law>::kLogVolume) {
    return planeStressOfAny<law, Steps>(terms, more, minor_strain);
  } else {
    auto plain = within(more, 0, 0);
    PlaneStress<B> out;
    if constexpr (LawFormula<law>::kConstantSlope && Steps == 1) {
      out = planeStressOfNeoHookean(terms, more, minor_strain);
      plain = within(more, kPlainAreaLow - 1, kPlainAreaHigh);
    } else {
      out = planeStressOfLog<law, Steps>(terms, WallMetric<B>{more, minor_strain, trace, more}, plain);
    }
    if (__builtin_expect(!allOf(plain), 0)) {
      const PlaneStress<B> other = planeStressOfAny<law, kRareSteps>(terms, more, minor_strain);
      out.energy = choose(plain, out.energy, other.energy);
      out.by_i = choose(plain, out.by_i, other.by_i);
      out.square = choose(plain, out.square, other.square);
    }
    return out;
  }
}

}  // namespace
}  // namespace vibe
