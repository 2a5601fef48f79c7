#pragma once

#include <cstdint>
#include <xsimd/xsimd.hpp>

#include "arithmetic/elementary.hpp"
#include "arithmetic/multiply_add.hpp"
#include "vibe_core/tissue/material_registry.hpp"

// Building blocks of elastic laws, for a scalar or a pack of scalars. Everything is a template or inline in an unnamed
// namespace: this file is compiled for several instruction sets, and a function shared between them could run on a
// machine that lacks the instructions.

namespace vibe {

/// Constants of a law, derived from E, nu and stiffening; their meaning depends on the law.
struct LawConstants {
  double shear;       ///< mu, or the law's own modulus in its place [Pa]
  double bulk;        ///< lambda, or the law's own modulus in its place [Pa]
  double stiffening;  ///< b, or 1/Jm
  double limit;       ///< above this K the function of K is extended by its second-order Taylor polynomial
  const MaterialLaw* registered = nullptr;  ///< for a law of another package; lives as long as the program
};

/// @throws Error for a material that checkMaterial rejects
LawConstants lawConstants(const Material& material);

/// Represents all registered laws where a law is needed at compile time.
constexpr Law kRegisteredLaw = static_cast<Law>(kLawCount);
/// A registered law by its number, or null if no law has it.
const MaterialLaw* registeredLaw(Law law);
LawDerivatives registeredLawAt(const LawConstants& constants, const LawInvariants& deformation);

namespace {

// Below this J, ln J is replaced by a twice continuously differentiable function: the curvature of ln J decreases
// linearly to zero over the width, and a straight line follows. The slope stays positive, so the force restores the
// volume. The energy grows only with J^2: single precision does not overflow up to a deformation of 1e5.
constexpr double kLogStart = 0.2;
constexpr double kLogWidth = 1.2;

template <class B>
struct ScalarOf {
  using Type = B;
};
template <class T, class A>
struct ScalarOf<xsimd::batch<T, A>> {
  using Type = T;
};

/// The constant in the precision of B, broadcast to all lanes.
template <class B>
inline B constant(double value) {
  return B(static_cast<typename ScalarOf<B>::Type>(value));
}

template <class B>
inline B larger(const B& a, const B& b) {
  return a > b ? a : b;
}
template <class T, class A>
inline xsimd::batch<T, A> larger(const xsimd::batch<T, A>& a, const xsimd::batch<T, A>& b) {
  return xsimd::max(a, b);
}
template <class B>
inline B smaller(const B& a, const B& b) {
  return a < b ? a : b;
}
template <class T, class A>
inline xsimd::batch<T, A> smaller(const xsimd::batch<T, A>& a, const xsimd::batch<T, A>& b) {
  return xsimd::min(a, b);
}

inline double choose(bool condition, double yes, double no) {
  return condition ? yes : no;
}
template <class A>
inline xsimd::batch<float, A> choose(const xsimd::batch_bool<float, A>& condition, const xsimd::batch<float, A>& yes,
                                     const xsimd::batch<float, A>& no) {
  return xsimd::select(condition, yes, no);
}

/// exp(x) - 1, accurate near 0; |x| < 80
inline double expMinusOne(double x) {
  return math::expm1(x);
}

/// The bits of a batch as another one. From version 9 on xsimd asks for the type of a lane instead of the batch.
template <class Out, class T, class A>
inline Out bitsAs(const xsimd::batch<T, A>& x) {
#if XSIMD_VERSION_MAJOR < 9
  return xsimd::bitwise_cast<Out>(x);
#else
  return xsimd::bitwise_cast<typename Out::value_type>(x);
#endif
}

/// In single precision: x = n ln 2 + r, and the Taylor series of exp(r) - 1 for |r| <= ln(2)/2 (relative error 2e-8).
/// The version in xsimd uses constants that are not compiled per instruction set.
template <class A>
inline xsimd::batch<float, A> expMinusOne(const xsimd::batch<float, A>& x) {
  using F = xsimd::batch<float, A>;
  using N = xsimd::batch<std::int32_t, A>;
  const F rounding(12582912.0f);  // 1.5 * 2^23: at this magnitude a float has no fractional bits
  const F rounded = mulAdd(x, F(1.442695041f), rounding);
  const F n = rounded - rounding;
  const F r = mulAdd(n, F(2.12194440e-4f), mulAdd(n, F(-0.693359375f), x));  // ln 2 in two parts, the first exact
  const F r2 = r * r;
  const F p23 = mulAdd(F(1.0f / 6), r, F(0.5f)), p45 = mulAdd(F(1.0f / 120), r, F(1.0f / 24));
  const F p67 = mulAdd(F(1.0f / 5040), r, F(1.0f / 720));
  const F small = mulAdd(mulAdd(mulAdd(p67, r2, p45), r2, p23), r2, r);
  const N exponent = bitsAs<N>(rounded) - N(0x4b400000 - 127);
  const F scale = bitsAs<F>(exponent << 23);
  return mulAdd(scale, small, scale - F(1.0f));
}

/// x - ln(1 + x), x > -1, with a small relative error also near 0, for the energy of small strains.
inline double logGap(double x) {
  return x - math::log1p(x);
}

/// In single precision: ln(1 + x) = ln m + e ln 2 with m in [sqrt(1/2), sqrt(2)) and t = m - 1; t - ln(1 + t) is
/// t^2/2 - t^3 p(t), p interpolated at Chebyshev nodes (relative error 1e-7).
template <class A>
inline xsimd::batch<float, A> logGap(const xsimd::batch<float, A>& x) {
  using F = xsimd::batch<float, A>;
  using N = xsimd::batch<std::int32_t, A>;
  const N root_half(0x3f3504f3);
  const N bits = bitsAs<N>(F(1.0f) + x) + (N(0x3f800000) - root_half);
  const F exponent = xsimd::to_float((bits >> 23) - N(127));
  const F mantissa = bitsAs<F>((bits & N(0x007fffff)) + root_half);
  const F t = xsimd::select(exponent == F(0.0f), x, mantissa - F(1.0f));
  // p in pairs of terms, to shorten the dependency chain
  const F t2 = t * t;
  const F p01 = mulAdd(F(-0.2500030642f), t, F(0.3333333073f)), p23 = mulAdd(F(-0.1664128146f), t, F(0.2000104509f));
  const F p45 = mulAdd(F(-0.1299818376f), t, F(0.1421449592f)), p67 = mulAdd(F(-0.07902743774f), t, F(0.1262231985f));
  const F p = mulAdd(mulAdd(p67, t2, p45), t2 * t2, mulAdd(p23, t2, p01));
  return mulAdd(t2, F(0.5f) - t * p, (x - t) - exponent * F(0.6931471806f));
}

/// L = ln J, extended for small J.
template <class B>
struct LogVolume {
  B value;
  B gap;        ///< (J - 1) - L
  B slope;      ///< L'
  B defect;     ///< 1 - L'
  B curvature;  ///< L''
};

/// @param j  J - 1
template <class B>
inline LogVolume<B> logVolume(const B& j) {
  const B curvature0 = constant<B>(1 / (kLogStart * kLogStart)), half(constant<B>(0.5));
  const B inside = larger(j, constant<B>(kLogStart - 1));
  const B below = j - inside;  // 0 for J above the start
  const B bent = larger(below, constant<B>(-kLogWidth));
  const B straight = below - bent;
  const B inverse = constant<B>(1) / (constant<B>(1) + inside);
  // integrals of the curvature 1 + bent / width
  const B first = bent * mulAdd(bent, constant<B>(0.5 / kLogWidth), constant<B>(1));
  const B second = bent * bent * mulAdd(bent, constant<B>(1 / (6 * kLogWidth)), half);
  LogVolume<B> out;
  out.slope = inverse - curvature0 * first;
  out.defect = mulAdd(curvature0, first, inside * inverse);
  out.gap = logGap(inside) + mulAdd(curvature0, second, below - inverse * bent) - out.slope * straight;
  out.value = j - out.gap;
  out.curvature = -(inverse * inverse) * mulAdd(bent, constant<B>(1 / kLogWidth), constant<B>(1));
  return out;
}

/// LawConstants in all lanes.
template <class B>
struct LawTerms {
  B shear, bulk, stiffening, limit;
  LawConstants constants;  ///< for registered laws, which compute in double precision

  explicit LawTerms(const LawConstants& c)
      : shear(constant<B>(c.shear)),
        bulk(constant<B>(c.bulk)),
        stiffening(constant<B>(c.stiffening)),
        limit(constant<B>(c.limit)),
        constants(c) {}
};

/// A function of K and its derivatives.
template <class B>
struct Profile {
  B value, first, second, third;
};

/// Energy per rest volume and its derivatives with respect to I and J [Pa]. `balance` is W_J + 2 W_I, which is 0 at
/// rest: with it the stress 2 W_I F + W_J cof F = 2 W_I (F - cof F) + balance cof F has no large terms that cancel.
template <class B>
struct LawAt {
  B energy;
  B by_i, by_j, balance;
  B by_ii, by_ij, by_jj;
};

}  // namespace
}  // namespace vibe
