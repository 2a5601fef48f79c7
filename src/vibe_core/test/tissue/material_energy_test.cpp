#include "vibe_core/tissue/material_registry.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "vibe_core/program/error.hpp"
#include "vibe_testing/element_worlds.hpp"

namespace vibe::material_energy_test {
namespace {

using namespace test;

constexpr double kStep = 1e-5;

// I - 3 and J - 1: lengthened, compressed, sheared, inside out
constexpr double kDeformations[][2] = {{0.3, 0.1}, {-0.8, -0.4}, {1.5, 0.0}, {2.0, -1.7}};

TEST(MaterialEnergy, DerivativesAreThoseOfTheEnergy) {
  for (const Law law : kLaws) {
    const MaterialEnergy energy(material(law));
    const auto at = [&](double i, double j) { return energy.at(i, j, i - 2 * j); };
    for (const auto& [i, j] : kDeformations) {
      SCOPED_TRACE(nameOf(law) + " at " + std::to_string(i) + ", " + std::to_string(j));
      const auto here = at(i, j);
      const auto right = at(i + kStep, j), left = at(i - kStep, j), up = at(i, j + kStep), down = at(i, j - kStep);
      const auto slope = [](double above, double below) { return (above - below) / (2 * kStep); };
      const double scale = kE + std::abs(here.by_i) + std::abs(here.by_j);
      EXPECT_NEAR(here.by_i, slope(right.energy, left.energy), 1e-5 * scale);
      EXPECT_NEAR(here.by_j, slope(up.energy, down.energy), 1e-5 * scale);
      const double second = scale + std::abs(here.by_ii) + std::abs(here.by_jj);
      EXPECT_NEAR(here.by_ii, slope(right.by_i, left.by_i), 1e-5 * second);
      EXPECT_NEAR(here.by_ij, slope(up.by_i, down.by_i), 1e-5 * second);
      EXPECT_NEAR(here.by_jj, slope(up.by_j, down.by_j), 1e-5 * second);
      EXPECT_NEAR(here.balance, here.by_j + 2 * here.by_i, 1e-12 * scale);
    }
  }
}

TEST(MaterialEnergy, SingleIsDouble) {
  for (const Law law : kLaws) {
    const MaterialEnergy energy(material(law));
    for (const auto& [i, j] : kDeformations) {
      SCOPED_TRACE(nameOf(law) + " at " + std::to_string(i) + ", " + std::to_string(j));
      const auto wide = energy.at(i, j, i - 2 * j);
      const auto single = energy.at(static_cast<float>(i), static_cast<float>(j), static_cast<float>(i - 2 * j));
      const double scale = kE + std::abs(wide.by_i) + std::abs(wide.by_j);
      EXPECT_NEAR(static_cast<double>(single.energy), wide.energy, 1e-5 * (scale + std::abs(wide.energy)));
      EXPECT_NEAR(static_cast<double>(single.by_i), wide.by_i, 1e-5 * scale);
      EXPECT_NEAR(static_cast<double>(single.balance), wide.balance, 1e-5 * scale);
    }
  }
}

TEST(MaterialEnergy, RejectsWhatNoMaterialIs) {
  EXPECT_THROW(MaterialEnergy({Law::NeoHookean, kE, 0.5, 0}), Error);
}

}  // namespace
}  // namespace vibe::material_energy_test
