#pragma once

#include <limits>

#include "tissue/law_terms.hpp"

// The built-in elastic laws, for a scalar or a pack of scalars; law_terms.hpp explains why everything is in an unnamed
// namespace. A law is a specialisation of LawFormula here and a line in scene/tissue_choices.hpp.

namespace vibe {
namespace {

/// Defaults for laws of the form W = mu/2 P(K) + lambda/2 (ln J)^2 with K = I - 3 - 2 ln J. Such a law adds kLimit and
/// profile().
struct LogVolumeLaw {
  static constexpr bool kLogVolume = true;        ///< has the form above, for which plane stress has a fast solution
  static constexpr bool kConstantSlope = false;   ///< P(K) = K
  static constexpr LawLimits kLimits{};           ///< of the parameters
  static constexpr int kThicknessSteps = 7;       ///< maximum number of Newton steps for the stretch across a wall
  static constexpr double kLastStepOfLog = 0.05;  ///< a step in 2 ln J below this may be the last one

  /// @param b      stiffening
  /// @param limit  the law's kLimit
  static LawConstants constants(double mu, double lambda, double b, double limit) {
    return {mu, lambda, b, b > 0 ? limit / b : std::numeric_limits<double>::infinity()};
  }
};

/// Defaults for laws of a general form W(I, J). Such a law adds constants() and at(), which fills everything but by_j.
struct GeneralLaw {
  static constexpr bool kLogVolume = false;
  static constexpr bool kConstantSlope = false;
  static constexpr LawLimits kLimits{true, false};
  static constexpr int kThicknessSteps = 2;
  static constexpr double kLimit = std::numeric_limits<double>::infinity();
};

/// P(K) and its derivatives for K below the limit; above it P is extended by its second-order Taylor polynomial. In
/// profile(), `inside` is K, or the limit if K is above it, and `x` is stiffening * inside.
template <Law law>
struct LawFormula;

template <>
struct LawFormula<Law::NeoHookean> : LogVolumeLaw {
  static constexpr bool kConstantSlope = true;
  static constexpr int kThicknessSteps = 1;
  static constexpr double kLimit = std::numeric_limits<double>::infinity();
};

template <>
struct LawFormula<Law::StableNeoHookean> : GeneralLaw {
  static LawConstants constants(double mu, double lambda, double, double) {
    return {4.0 / 3 * mu, lambda + 5.0 / 6 * mu, 0, 0};
  }

  template <class B>
  [[gnu::always_inline]] static LawAt<B> at(const LawTerms<B>& c, const B& i, const B& j, const B& even) {
    const B zero = constant<B>(0), half = constant<B>(0.5);
    // i - ln(1 + i/4) = 3/4 i + the gap of i/4
    const B quarter = constant<B>(0.25) * i, inverse = constant<B>(1) / (constant<B>(4) + i);
    LawAt<B> out;
    out.energy = mulAdd(constant<B>(0.375) * c.shear, even, half * mulAdd(c.bulk * j, j, c.shear * logGap(quarter)));
    out.by_i = half * c.shear * (constant<B>(1) - inverse);
    out.balance = mulAdd(c.bulk, j, c.shear * quarter * inverse);
    out.by_ii = half * c.shear * inverse * inverse, out.by_ij = zero, out.by_jj = c.bulk;
    return out;
  }
};

template <>
struct LawFormula<Law::MacklinMueller> : GeneralLaw {
  static LawConstants constants(double mu, double lambda, double, double) { return {mu, lambda + mu, 0, 0}; }

  template <class B>
  [[gnu::always_inline]] static LawAt<B> at(const LawTerms<B>& c, const B&, const B& j, const B& even) {
    const B zero = constant<B>(0), half = constant<B>(0.5);
    LawAt<B> out;
    out.energy = half * mulAdd(c.shear, even, c.bulk * j * j);
    out.by_i = half * c.shear;
    out.balance = c.bulk * j;
    out.by_ii = zero, out.by_ij = zero, out.by_jj = c.bulk;
    return out;
  }
};

template <>
struct LawFormula<Law::Fung> : LogVolumeLaw {
  static constexpr LawLimits kLimits{false, true};
  static constexpr double kLimit = 6;  ///< stiffness increases by a factor of 400: a stretch of 3 for b = 1

  template <class B>
  [[gnu::always_inline]] static Profile<B> profile(const LawTerms<B>& c, const B&, const B& x) {
    const B grown = expMinusOne(x), first = constant<B>(1) + grown, second = c.stiffening * first;
    return {grown / c.stiffening, first, second, c.stiffening * second};
  }
};

template <>
struct LawFormula<Law::Gent> : LogVolumeLaw {
  static constexpr LawLimits kLimits{false, true};
  static constexpr double kLimit = 0.95;           ///< stiffness increases by a factor of 20
  static constexpr double kLastStepOfLog = 0.004;  ///< its derivatives grow too fast for a larger value

  template <class B>
  [[gnu::always_inline]] static Profile<B> profile(const LawTerms<B>& c, const B& inside, const B& x) {
    const B one = constant<B>(1), first = one / (one - x), second = c.stiffening * first * first;
    return {inside + logGap(B(-x)) / c.stiffening, first, second, constant<B>(2) * c.stiffening * first * second};
  }
};

template <>
struct LawFormula<Law::Yeoh> : LogVolumeLaw {
  static constexpr double kLimit = 100;  ///< stiffness increases by a factor of 5,000

  template <class B>
  [[gnu::always_inline]] static Profile<B> profile(const LawTerms<B>& c, const B& inside, const B& x) {
    const B one = constant<B>(1);
    return {inside * mulAdd(x, mulAdd(x, constant<B>(1.0 / 6), constant<B>(0.5)), one),
            mulAdd(x, mulAdd(x, constant<B>(0.5), one), one), c.stiffening * (one + x), c.stiffening * c.stiffening};
  }
};

/// A law of another package, evaluated lane by lane in double precision.
template <>
struct LawFormula<kRegisteredLaw> : GeneralLaw {
  static constexpr int kThicknessSteps = 7;

  static LawConstants constants(double mu, double lambda, double b, double limit) { return {mu, lambda, b, limit}; }

  static LawAt<double> at(const LawTerms<double>& c, const double&, const double& j, const double& even) {
    const LawDerivatives w = registeredLawAt(c.constants, {even + 2 * j, j, even});
    return {w.energy, w.by_i, 0, w.by_j + 2 * w.by_i, w.by_ii, w.by_ij, w.by_jj};
  }

  template <class A>
  static LawAt<xsimd::batch<float, A>> at(const LawTerms<xsimd::batch<float, A>>& c, const xsimd::batch<float, A>&,
                                          const xsimd::batch<float, A>& j, const xsimd::batch<float, A>& even) {
    using F = xsimd::batch<float, A>;
    float in[2][F::size], out[6][F::size];
    j.store_unaligned(in[0]), even.store_unaligned(in[1]);
    for (std::size_t k = 0; k < F::size; ++k) {
      const double volume = in[0][k], difference = in[1][k];
      const LawDerivatives w = registeredLawAt(c.constants, {difference + 2 * volume, volume, difference});
      const double values[6] = {w.energy, w.by_i, w.by_j + 2 * w.by_i, w.by_ii, w.by_ij, w.by_jj};
      for (std::size_t n = 0; n < 6; ++n) out[n][k] = static_cast<float>(values[n]);
    }
    const auto lanes = [&out](int n) { return F::load_unaligned(out[n]); };
    return {lanes(0), lanes(1), constant<F>(0), lanes(2), lanes(3), lanes(4), lanes(5)};
  }
};

}  // namespace
}  // namespace vibe
