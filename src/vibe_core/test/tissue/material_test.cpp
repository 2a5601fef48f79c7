#include "vibe_core/tissue/material_registry.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "tissue/material_law.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::material_test {
namespace {

constexpr double kE = 3e4, kNu = 0.45;
// every law of the list
#define VIBE_LAW(name, word, formula) Law::name,
const std::vector<Law> kLaws = {VIBE_MATERIAL_LAWS(VIBE_LAW)};
#undef VIBE_LAW

Material material(Law law, double stiffening = 0.8) {
  return {law, kE, kNu, stiffening};
}

LawAt<double> at(const Material& m, double i, double j) {
  const LawTerms<double> terms(lawConstants(m));
  return withLaw(m.law, [&](auto tag) { return lawAt<decltype(tag)::value>(terms, i, j, i - 2 * j); });
}

struct Pair {
  double i, j;
};

// I - 3 and J - 1 of stretched, sheared, inverted and collapsed material, on both sides of every continuation.
std::vector<Pair> states() {
  return {{0.01, 0.002}, {0.3, -0.1},  {2.5, 0.4},   {6.0, -0.3},    {1.0, -0.79},  {1.0, -0.81}, {-3, -1},
          {0.5, -1.5},   {4.0, -3.0},  {9.0, 2.0},   {40.0, 3.0},    {1.05, 0.02},  {1.3, 0.02},  {8.0, 0.1},
          {-1.5, -0.6},  {200.0, -50}, {190.0, 0.5}, {3.0, -1.9999}, {3.0, -2.0001}};
}

TEST(MaterialLaw, DerivativesAreThoseOfTheEnergy) {
  const double h = 1e-5;
  for (const Law law : kLaws)
    for (const Pair& s : states()) {
      const Material m = material(law);
      const LawAt<double> w = at(m, s.i, s.j);
      const LawAt<double> i1 = at(m, s.i + h, s.j), i0 = at(m, s.i - h, s.j);
      const LawAt<double> j1 = at(m, s.i, s.j + h), j0 = at(m, s.i, s.j - h);
      const double tolerance = 2e-6 * (kE + std::abs(w.by_jj) + std::abs(w.by_j) + std::abs(w.by_i) + w.energy);
      SCOPED_TRACE(testing::Message() << "law " << static_cast<int>(law) << " at " << s.i << ", " << s.j);
      EXPECT_NEAR(w.by_i, (i1.energy - i0.energy) / (2 * h), tolerance);
      EXPECT_NEAR(w.by_j, (j1.energy - j0.energy) / (2 * h), tolerance);
      EXPECT_NEAR(w.balance, w.by_j + 2 * w.by_i, 1e-12 * tolerance / 2e-6);
      EXPECT_NEAR(w.by_ii, (i1.by_i - i0.by_i) / (2 * h), tolerance);
      EXPECT_NEAR(w.by_ij, (j1.by_i - j0.by_i) / (2 * h), tolerance);
      EXPECT_NEAR(w.by_jj, (j1.by_j - j0.by_j) / (2 * h), 100 * tolerance);  // third derivative jumps at -0.8, -2
    }
}

TEST(MaterialLaw, FormulasAreThoseOfThePublications) {
  const double mu = kE / (2 * (1 + kNu)), lambda = kE * kNu / ((1 + kNu) * (1 - 2 * kNu));
  const double i = 0.7, j = 0.2, lj = std::log(1 + j), k = i - 2 * lj, b = 0.8;
  const double volume = lambda / 2 * lj * lj;
  EXPECT_NEAR(at(material(Law::NeoHookean), i, j).energy, mu / 2 * k + volume, 1e-9 * kE);
  EXPECT_NEAR(at(material(Law::Fung), i, j).energy, mu / 2 * (std::exp(b * k) - 1) / b + volume, 1e-9 * kE);
  EXPECT_NEAR(at(material(Law::Gent), i, j).energy, -mu / 2 / b * std::log(1 - k * b) + volume, 1e-9 * kE);
  EXPECT_NEAR(at(material(Law::Yeoh), i, j).energy, mu / 2 * (k + b / 2 * k * k + b * b / 6 * k * k * k) + volume,
              1e-9 * kE);
  const double lm = lambda + mu, g = 1 + mu / lm;
  const auto mm = [&](double x, double y) { return mu / 2 * x + lm / 2 * (1 + y - g) * (1 + y - g); };
  EXPECT_NEAR(at(material(Law::MacklinMueller), i, j).energy, mm(i, j) - mm(0, 0), 1e-9 * kE);
  const double ms = 4.0 / 3 * mu, ls = lambda + 5.0 / 6 * mu, a = 1 + ms / ls - ms / (4 * ls);
  const auto snh = [&](double x, double y) {
    return ms / 2 * x + ls / 2 * (1 + y - a) * (1 + y - a) - ms / 2 * std::log(4 + x);
  };
  EXPECT_NEAR(at(material(Law::StableNeoHookean), i, j).energy, snh(i, j) - snh(0, 0), 1e-9 * kE);
}

// At rest sigma = 4 W_I eps + (4 W_II + W_JJ - 2 W_I + 4 W_IJ) tr(eps): Lame's constants.
TEST(MaterialLaw, AgreesWithYoungAndPoissonAtRest) {
  const double mu = kE / (2 * (1 + kNu)), lambda = kE * kNu / ((1 + kNu) * (1 - 2 * kNu));
  for (const Law law : kLaws) {
    const LawAt<double> w = at(material(law), 0, 0);
    EXPECT_EQ(w.energy, 0);
    EXPECT_EQ(w.balance, 0);
    EXPECT_NEAR(2 * w.by_i, mu, 1e-10 * mu);
    EXPECT_NEAR(4 * w.by_ii + w.by_jj - 2 * w.by_i + 4 * w.by_ij, lambda, 1e-10 * lambda);
  }
}

TEST(MaterialLaw, YeohWithoutStiffeningIsNeoHookean) {
  const LawAt<double> a = at(material(Law::Yeoh, 0), 0.9, -0.2), b = at(material(Law::NeoHookean), 0.9, -0.2);
  EXPECT_DOUBLE_EQ(a.energy, b.energy);
  EXPECT_DOUBLE_EQ(a.by_i, b.by_i);
  EXPECT_DOUBLE_EQ(a.by_jj, b.by_jj);
}

TEST(MaterialLaw, PushesInvertedMaterialBack) {
  for (const Law law : kLaws)
    for (double j = -0.9; j > -1e5; j *= 1.5) EXPECT_LT(at(material(law), 1.0, j).by_j, 0) << j;
}

// Relative to the largest derivative: second derivatives of stiff laws are large numbers of both signs.
template <Law law>
void expectSinglePrecision(const Pair& s) {
  using F = xsimd::batch<float, xsimd::sse2>;
  const LawConstants constants = lawConstants(material(law));
  const float i = static_cast<float>(s.i), j = static_cast<float>(s.j);
  const LawAt<F> f = lawAt<law>(LawTerms<F>(constants), F(i), F(j), F(i - 2 * j));
  const LawAt<double> d = at(material(law), i, j);
  const double first = std::abs(d.by_i) + std::abs(d.by_j);
  const double second = std::abs(d.by_ii) + std::abs(d.by_ij) + std::abs(d.by_jj);
  EXPECT_NEAR(f.energy.get(2), d.energy, 2e-6 * std::abs(d.energy) + 1e-12 * first) << s.i << ' ' << s.j;
  EXPECT_NEAR(f.by_i.get(0), d.by_i, 2e-6 * first);
  EXPECT_NEAR(f.by_j.get(1), d.by_j, 2e-6 * first);
  EXPECT_NEAR(f.balance.get(3), d.balance, 3e-6 * std::abs(d.balance) + 5e-7 * first * std::min(1.0, std::abs(s.j)));
  EXPECT_NEAR(f.by_ii.get(2), d.by_ii, 4e-6 * second);
  EXPECT_NEAR(f.by_ij.get(1), d.by_ij, 4e-6 * second);
  EXPECT_NEAR(f.by_jj.get(0), d.by_jj, 4e-6 * second);
}

TEST(MaterialLaw, SinglePrecisionAgreesWithDouble) {
  for (const Law law : kLaws)
    for (const Pair& s : states()) {
      SCOPED_TRACE(testing::Message() << "law " << static_cast<int>(law));
      withLaw(law, [&](auto tag) { expectSinglePrecision<decltype(tag)::value>(s); });
    }
}

// exp(x) - 1 to a few roundings. The gap x - ln(1 + x) past the first reduction of the argument, 0.0686 at 0.4142, is
// a difference of numbers near 0.7 that are each rounded to 3e-8: 1e-6 of it; -0.2929, where it is 0.0537, likewise.
TEST(MaterialLaw, PackFunctionsAreExactToRounding) {
  using F = xsimd::batch<float, xsimd::sse2>;
  for (double x = 1e-7; x < 80; x *= 1.03) {
    const float value = static_cast<float>(x);
    const double exact = value;
    EXPECT_NEAR(expMinusOne(F(value)).get(1), std::expm1(exact), 4e-7 * std::expm1(exact)) << x;
    // below 1e-4 the series: the difference cancels in double precision too
    const double gap = exact < 1e-4 ? exact * exact * (0.5 - exact / 3) : exact - std::log1p(exact);
    EXPECT_NEAR(logGap(F(value)).get(2), gap, 1e-6 * gap) << x;
    if (exact > 0.95) continue;
    EXPECT_NEAR(expMinusOne(F(-value)).get(1), std::expm1(-exact), 4e-7 * -std::expm1(-exact)) << -x;
    const double below = exact < 1e-4 ? exact * exact * (0.5 + exact / 3) : -exact - std::log1p(-exact);
    EXPECT_NEAR(logGap(F(-value)).get(2), below, 1e-6 * below) << -x;
  }
}

TEST(MaterialLaw, SinglePrecisionKeepsTheEnergyOfATinyStrain) {
  using F = xsimd::batch<float, xsimd::sse2>;
  const float strain = 1e-6f;  // uniaxial H: i = 2 h + h^2, j = h
  const double expected = 0.5 * (kE / (2 * (1 + kNu)) * 2 + kE * kNu / ((1 + kNu) * (1 - 2 * kNu))) * 1e-12;
  for (const Law law : kLaws)
    withLaw(law, [&](auto tag) {
      const LawTerms<F> terms(lawConstants(material(law)));
      const F h(strain), i = 2.0f * h + h * h;
      const LawAt<F> w = lawAt<decltype(tag)::value>(terms, i, h, F(h * h));
      EXPECT_NEAR(w.energy.get(0), expected, 1e-5 * expected) << static_cast<int>(law);
    });
}

TEST(MaterialLaw, ExtremeDeformationHasFiniteEnergyInSinglePrecision) {
  using F = xsimd::batch<float, xsimd::sse2>;
  for (const Law law : kLaws)
    for (const float sign : {1.0f, -1.0f})
      withLaw(law, [&](auto tag) {
        const F i(3e8f), j(sign * 1e12f);  // stretched 1e4 times in every direction
        const LawAt<F> w = lawAt<decltype(tag)::value>(LawTerms<F>(lawConstants(material(law))), i, j, F(i - 2 * j));
        EXPECT_TRUE(std::isfinite(w.energy.get(0))) << static_cast<int>(law) << ' ' << sign;
        EXPECT_TRUE(std::isfinite(w.by_i.get(0)) && std::isfinite(w.by_j.get(0)));
      });
}

void expectRejected(const Material& m, const std::string& part) {
  try {
    checkMaterial(m, "wall.yaml:7");
    FAIL() << "accepted, expected to hear of " << part;
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find(part), std::string::npos) << text;
    EXPECT_EQ(text.rfind("wall.yaml:7", 0), 0u) << text;
  }
}

TEST(Material, RefusesWhatHasNoPositiveEnergy) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NO_THROW(checkMaterial({Law::NeoHookean, 1e4, 0.0, 0}, "x"));
  EXPECT_NO_THROW(checkMaterial({Law::StableNeoHookean, 1e4, -0.4, 0}, "x"));
  EXPECT_NO_THROW(checkMaterial({Law::Yeoh, 1e4, 0.49, 0}, "x"));
  expectRejected({Law::NeoHookean, 0, 0.3, 0}, "Young");
  expectRejected({Law::NeoHookean, nan, 0.3, 0}, "Young");
  expectRejected({Law::NeoHookean, 1e4, 0.5, 0}, "Poisson");
  expectRejected({Law::MacklinMueller, 1e4, -1, 0}, "Poisson");
  expectRejected({Law::NeoHookean, 1e4, -0.2, 0}, "Poisson");
  expectRejected({Law::Yeoh, 1e4, 0.3, -1}, "stiffening");
  expectRejected({Law::Fung, 1e4, 0.3, 0}, "stiffening");
  expectRejected({Law::Gent, 1e4, 0.3, 0}, "stiffening");
  EXPECT_THROW(lawConstants({Law::NeoHookean, 1e4, nan, 0}), Error);
}

}  // namespace
}  // namespace vibe::material_test
