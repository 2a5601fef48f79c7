#pragma once

#include "tetrahedra_point.hpp"

// The laws of a solid in a wall without stress across it, for one wall or a pack of them; see material_law.hpp for why
// everything is in an unnamed namespace.

namespace vibe {
namespace {

// Least derivative of the stress across the wall by its stretch, in shear moduli; it is 1 at rest or more.
constexpr double kLeastSlope = 0.01;
constexpr int kRareSteps = 7;  // of Newton's method in states that are too rare to be fast

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

  WallTerms(const LawConstants& constants, double nu)
      : law(constants),
        poisson_ratio(constant<B>(nu)),
        thickness_guess(constant<B>(nu / (1 - nu))),
        quarter_bulk(constant<B>(constants.bulk / 4)) {}
};

/// Energy per volume at rest in plane stress [Pa].
template <class B>
struct PlaneStress {
  B energy;
  B by_i;    ///< W_I
  B square;  ///< y^2 - 1 for the squared stretch D y^2 across the wall
};

/// One evaluation of Newton's method for eta, see planeStress.
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
  out.slope = larger(B(mulAdd(area, curve, pull)), B(constant<B>(kLeastSlope) * c.shear));
  const B step = -out.residual / out.slope;
  out.change = smaller(B(four * y), larger(B(constant<B>(-0.8) * y), step));
  return out;
}

/// The law with the stretch across the wall that leaves it without stress. With the metric C = 1 + S, D = det C, the
/// squared stretch across is written D y^2, so J = D y: dW/dy = D (2 W_I y + W_J) has no singularity for D = 0, and the
/// stress follows from dW/dC = W_I (1 - y^2 cof C) alone. All is formed from small differences to rest:
/// I - 3 - 2 (J - 1) = D (y - 1)^2 - det S.
/// The last step of Newton's method is not followed by an evaluation: energy and W_I come from their expansions.
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

/// Within these bounds of D the log laws have J above kLogStart in plane stress, and single precision does not
/// overflow.
constexpr double kPlainAreaLow = 0.1, kPlainAreaHigh = 1e6;

/// One evaluation of Newton's method for z = ln c, see planeStressOfLog.
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

/// The same for the laws P(K) + lambda/2 (ln J)^2 while J is not small, by the logarithm z of the squared stretch
/// across c: dW/dz = P' (c - 1) + lambda/2 ln J is nearly linear in z. One logarithm per step.
template <Law law, int Steps, class B>
[[gnu::always_inline]] inline PlaneStress<B> planeStressOfLog(const WallTerms<B>& terms, const B& more,
                                                              const B& minor_strain) {
  const B one = constant<B>(1), half = constant<B>(0.5), sixth = constant<B>(1.0 / 6);
  const B area = one + more, widening = mulAdd(terms.thickness_guess, more, one);
  const B both = one / (area * widening);
  B c = both * area, across = -(terms.thickness_guess * more) * c;  // c and c - 1
  PlaneStress<B> out;
  for (int step = 0; step < Steps; ++step) {
    const LogStep<B> at = logStep<law>(terms.law, more, minor_strain, across);
    const B slope = mulAdd(at.p.first, c, mulAdd(B(at.p.second * across), across, terms.quarter_bulk));
    const B z = larger(smaller(B(-at.residual / slope), one), B(-one));
    const B growth = z * mulAdd(z, mulAdd(z, sixth, half), one);
    out.energy = mulAdd(z, B(mulAdd(B(half * slope), z, at.residual)), at.energy);
    out.by_i = mulAdd(at.p.second, B(z * mulAdd(B(half * c), z, across)), at.p.first);
    across = mulAdd(c, growth, across);
    c = mulAdd(c, growth, c);
  }
  out.square = (across - more) * (both * widening);
  return out;
}

/// The same for the neo-Hookean law, where P' is constant: one step of fourth order is enough (relative error of the
/// stress 4e-6 for nu = 0.3 and D = 4, less for a larger nu), and one division.
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

inline bool within(double x, double low, double high) {
  return x > low && x < high;
}
inline bool allOf(bool condition) {
  return condition;
}
inline double choose(bool condition, double yes, double no) {
  return condition ? yes : no;
}
template <class A>
inline xsimd::batch_bool<float, A> within(const xsimd::batch<float, A>& x, double low, double high) {
  using F = xsimd::batch<float, A>;
  return (x > constant<F>(low)) & (x < constant<F>(high));
}
template <class A>
inline bool allOf(const xsimd::batch_bool<float, A>& condition) {
  return xsimd::all(condition);
}
template <class A>
inline xsimd::batch<float, A> choose(const xsimd::batch_bool<float, A>& condition, const xsimd::batch<float, A>& yes,
                                     const xsimd::batch<float, A>& no) {
  return xsimd::select(condition, yes, no);
}

/// @param trace, minor_strain  of S
template <Law law, int Steps, class B>
[[gnu::always_inline]] inline PlaneStress<B> planeStress(const WallTerms<B>& terms, const B& trace,
                                                         const B& minor_strain) {
  const B more = trace + minor_strain;
  if constexpr (law == Law::StableNeoHookean || law == Law::MacklinMueller) {
    return planeStressOfAny<law, Steps>(terms, more, minor_strain);
  } else {
    PlaneStress<B> out;
    if constexpr (law == Law::NeoHookean && Steps == 1)
      out = planeStressOfNeoHookean(terms, more, minor_strain);
    else
      out = planeStressOfLog<law, Steps>(terms, more, minor_strain);
    const auto plain = within(more, kPlainAreaLow - 1, kPlainAreaHigh);
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
