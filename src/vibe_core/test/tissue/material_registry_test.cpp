#include "vibe_core/tissue/material_registry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tissue/material_law.hpp"
#include "tissue/shell_worlds.hpp"
#include "vibe_core/scene/words.hpp"
#include "vibe_testing/expect_error.hpp"

namespace vibe::material_registry_test {
namespace {

using namespace test;

/// The law of Macklin and Mueller once more, from outside: mu/2 (I - 3) + lm/2 (J - g)^2, less its value at rest.
class Copy : public MaterialLaw {
 public:
  std::string formula() const override { return "as macklin_mueller"; }
  LawLimits limits() const override { return {true, false}; }
  LawDerivatives at(const LawParameters& p, const LawInvariants& x) const override {
    const double lm = p.lambda + p.shear;
    return {p.shear / 2 * x.difference + lm / 2 * x.volume * x.volume, p.shear / 2, lm * x.volume - p.shear, 0, 0, lm};
  }
};

Law copyOfMacklinMueller() {
  static const Law law = registerMaterialLaw("copy_of_macklin_mueller", std::make_shared<Copy>());
  return law;
}

TEST(MaterialRegistry, ShellOfARegisteredLawIsThatOfTheSameLawInTheLibrary) {
  for (const ShellKernel& kernel : {shellKernelSse2(), shellKernel()}) {
    const ShellElements ours(patchwork(Law::MacklinMueller), {0, 0, 0}, kernel);
    const ShellElements theirs(patchwork(copyOfMacklinMueller()), {0, 0, 0}, kernel);
    const Eigen::VectorXd u = randomDisplacement(ours.nodeCount(), 0.1 * kSide);
    const Evaluation exact = inDouble(ours, u), same = inDouble(theirs, u);
    EXPECT_NEAR(same.energy, exact.energy, 1e-9 * exact.energy);
    EXPECT_LT((same.gradient - exact.gradient).norm(), 1e-9 * exact.gradient.norm());
    const Evaluation fast = inSingle(theirs, u);
    EXPECT_NEAR(fast.energy, exact.energy, 1e-5 * exact.energy);
    EXPECT_LT((fast.gradient - exact.gradient).norm(), 1e-5 * exact.gradient.norm());
    const Eigen::MatrixXd k = denseStiffness(ours, u);
    EXPECT_LT((denseStiffness(theirs, u) - k).norm(), 1e-9 * k.norm());
    // control: another law is another shell
    const ShellElements other(patchwork(Law::Fung), {0, 0, 0}, kernel);
    EXPECT_GT(std::abs(inDouble(other, u).energy - exact.energy), 1e-3 * exact.energy);
  }
}

TEST(MaterialRegistry, WordsNumbersAndLawsBelongTogether) {
  const Law law = copyOfMacklinMueller();
  EXPECT_EQ(nameOf(law), "copy_of_macklin_mueller");
  EXPECT_EQ(lawByName("copy_of_macklin_mueller"), law);
  EXPECT_GE(static_cast<int>(law), kLawCount);
  EXPECT_EQ(lawByName("yeoh"), Law::Yeoh);
  EXPECT_EQ(nameOf(Law::MacklinMueller), "macklin_mueller");
  EXPECT_ERROR(lawByName("copy_of_macklin_muller"), "did you mean 'copy_of_macklin_mueller'?");
  EXPECT_ERROR(registerMaterialLaw("yeoh", std::make_shared<Copy>()), "exists already");
  EXPECT_ERROR(registerMaterialLaw("nothing", nullptr), "there is no object");
  EXPECT_ERROR(checkMaterial({static_cast<Law>(1000), kE, kNu, 0}, "wall.yaml:7"), "a number that no law has");
}

TEST(MaterialRegistry, LimitsOfARegisteredLawHold) {
  EXPECT_EQ(errorOf([] { checkMaterial({copyOfMacklinMueller(), kE, -0.2, 0}, "x"); }), "no error");
  EXPECT_ERROR(checkMaterial({Law::Yeoh, kE, -0.2, 0}, "x"), "allowed below 0: stable_neo_hookean, macklin_mueller");
}

/// A law that breaks one rule.
class Broken : public Copy {
 public:
  explicit Broken(int what) : what_(what) {}
  LawDerivatives at(const LawParameters& p, const LawInvariants& x) const override {
    LawDerivatives w = Copy::at(p, x);
    if (what_ == 0) w.energy += 1;
    if (what_ == 1) w.by_i *= 1.01, w.by_j -= 0.01 * p.shear;
    if (what_ == 2) w.by_j += 0.01 * p.shear;
    if (what_ == 3) w.by_jj *= 1.01;
    if (what_ == 4) w.by_j += 0.01 * p.shear * x.volume * x.volume;
    if (what_ == 5 && x.volume < -0.99) w.energy = std::numeric_limits<double>::quiet_NaN();
    return w;
  }

 private:
  int what_;
};

TEST(MaterialRegistry, LawsThatBreakARuleAreRejected) {
  const std::vector<std::string> reasons = {"the energy at rest is 1", "2 W_I at rest",
                                            "W_J + 2 W_I at rest",     "4 W_II + 4 W_IJ + W_JJ - 2 W_I at rest",
                                            "W_J at I - 3 = 0.6",      "no finite value at J = 0.001"};
  for (std::size_t k = 0; k < reasons.size(); ++k)
    EXPECT_ERROR(registerMaterialLaw("broken", std::make_shared<Broken>(static_cast<int>(k))), reasons[k]);
  for (const Choice& choice : choicesOf("tissue.law")) EXPECT_NE(choice.word, "broken");
  // control: without a broken rule it is accepted
  EXPECT_EQ(errorOf([] { registerMaterialLaw("unbroken", std::make_shared<Broken>(-1)); }), "no error");
}

}  // namespace
}  // namespace vibe::material_registry_test
