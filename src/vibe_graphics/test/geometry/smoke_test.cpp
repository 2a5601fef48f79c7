#include "vibe_graphics/geometry/argon_traces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "vibe_graphics/testing/tube_organ.hpp"

namespace vibe::graphics::smoke_test {
namespace {

constexpr std::size_t kBurnt = 2000;  // a particle in the middle of the tube

TissueFrame frameAt(const TissueMesh& mesh, double time, double dose) {
  TissueFrame frame;
  frame.time = time;
  frame.dose.assign(mesh.particle_count, 0);
  frame.dose[kBurnt] = static_cast<float>(dose);
  return frame;
}

/// Energy after a beam of 40 J/s that is on from 1 s to 3 s, at `end`, seen in steps of this length.
double afterBeam(const TissueMesh& mesh, double end, double step) {
  Smoke smoke(mesh);
  for (int k = 0; k * step < end + step / 2; ++k)
    smoke.see(frameAt(mesh, k * step, 40 * std::clamp(k * step - 1, 0.0, 2.0)));
  return smoke.energy();
}

TEST(SmokeTest, HalfIsGoneAfterAHalfLife) {
  const TissueMesh mesh = test::TubeOrgan().mesh();
  Smoke smoke(mesh);
  smoke.see(frameAt(mesh, 5, 0));
  smoke.see(frameAt(mesh, 5, 40));
  const double before = smoke.energy();
  ASSERT_GT(before, 0);
  smoke.see(frameAt(mesh, 5 + kSmokeLife * std::log(2), 40));
  EXPECT_NEAR(smoke.energy(), before / 2, 1e-12 * before);
  smoke.see(frameAt(mesh, 5 + 10 * kSmokeLife, 40));
  EXPECT_NEAR(smoke.energy(), before * std::exp(-10), 1e-12 * before);
}

TEST(SmokeTest, DoesNotDependOnTheRateOfFrames) {
  const TissueMesh mesh = test::TubeOrgan().mesh();
  const double fine = afterBeam(mesh, 9, 0.01);
  for (const double step : {0.02, 0.1, 0.5, 1.0}) EXPECT_NEAR(afterBeam(mesh, 9, step), fine, 1e-5 * fine) << step;
  EXPECT_GT(std::abs(afterBeam(mesh, 9, 1.5) / fine - 1), 1e-4);  // control: the beam changes within a step
}

// The exact solution of the equation with a beam of constant power.
TEST(SmokeTest, FollowsItsEquation) {
  const test::TubeOrgan organ;
  const TissueMesh mesh = organ.mesh();
  // two triangles of a cell, each a third of whose area belongs to each corner: one cell per particle
  const double cell = organ.length / (organ.rows - 1) * 2 * organ.radius * std::sin(M_PI / organ.around);
  const double share = cell / (M_PI * kSpotRadius * kSpotRadius);
  const double exact = 40 * share * kSmokeLife * (std::exp(-6 / kSmokeLife) - std::exp(-8 / kSmokeLife));
  EXPECT_NEAR(afterBeam(mesh, 9, 0.5), exact, 1e-4 * exact);
}

TEST(SmokeTest, GrowsWithTheEnergyUpToItsLimit) {
  const TissueMesh mesh = test::TubeOrgan().mesh();
  const auto extinctionOf = [&](double dose) {
    Smoke smoke(mesh);
    smoke.see(frameAt(mesh, 0, 0));
    smoke.see(frameAt(mesh, 0.1, dose));
    return smoke.extinction();
  };
  const double once = extinctionOf(100);
  ASSERT_GT(once, 0);
  EXPECT_NEAR(extinctionOf(200), 2 * once, 1e-9);
  EXPECT_EQ(extinctionOf(1e9), kDensestSmoke);
  EXPECT_LT(extinctionOf(200), kDensestSmoke);  // control
}

// The same burnt area makes the same smoke, with however many particles.
TEST(SmokeTest, DoesNotDependOnTheMesh) {
  const auto energyOf = [](std::uint32_t rows, std::uint32_t around) {
    test::TubeOrgan organ;
    organ.rows = rows, organ.around = around;
    const TissueMesh mesh = organ.mesh();
    TissueFrame frame;
    frame.dose.assign(mesh.particle_count, 0);
    Smoke smoke(mesh);
    smoke.see(frame);
    frame.dose.assign(mesh.particle_count, 1);
    smoke.see(frame);
    return smoke.energy();
  };
  EXPECT_NEAR(energyOf(80, 64), energyOf(161, 96), 2e-3 * energyOf(80, 64));
  EXPECT_GT(energyOf(80, 64), 500);  // 0.05 m^2 are 1000 spots
}

TEST(SmokeTest, IsGoneWhenTimeOrDosesAreSetBack) {
  const TissueMesh mesh = test::TubeOrgan().mesh();
  const auto energyAfter = [&](const TissueFrame& last) {
    Smoke smoke(mesh);
    smoke.see(frameAt(mesh, 10, 0));
    smoke.see(frameAt(mesh, 11, 80));
    smoke.see(last);
    return smoke.energy();
  };
  EXPECT_GT(energyAfter(frameAt(mesh, 11.5, 80)), 0);  // control
  EXPECT_EQ(energyAfter(frameAt(mesh, 10.5, 80)), 0);
  EXPECT_EQ(energyAfter(frameAt(mesh, 11.5, 79)), 0);
  TissueFrame without = frameAt(mesh, 11.5, 0);
  without.dose.clear();
  EXPECT_EQ(energyAfter(without), 0);
  EXPECT_EQ(energyAfter(frameAt(mesh, 11.5, std::numeric_limits<double>::quiet_NaN())), 0);
}

TEST(SmokeTest, WhatWasBurntBeforeDoesNotSmoke) {
  const TissueMesh mesh = test::TubeOrgan().mesh();
  Smoke smoke(mesh);
  smoke.see(frameAt(mesh, 100, 80));
  EXPECT_EQ(smoke.energy(), 0);
  smoke.see(frameAt(mesh, 101, 81));
  EXPECT_GT(smoke.energy(), 0);  // control
}

}  // namespace
}  // namespace vibe::graphics::smoke_test
