#include <gtest/gtest.h>

#include <cmath>

#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/simulation/simulator.hpp"

namespace {

constexpr double kE = 50e3, kNu = 0.4, kThickness = 2e-3;
// Relative. The bending of the sphere adds about (thickness / radius)^2 / 12 = 1e-4.
constexpr double kTolerance = 1e-3;
constexpr double kMu = kE / (2 * (1 + kNu)), kLambda = kE * kNu / ((1 + kNu) * (1 - 2 * kNu));

vibe::Scene balloon(const std::string& law, const std::string& stiffening) {
  return vibe::parseScene(
      "geometry: {kind: sphere, particles: 642, radius: 5 cm}\n"
      "tissue: {law: " +
          law + ", stiffening: " + stiffening +
          ", young_modulus: 50 kPa, poisson_ratio: 0.4,\n"
          "  thickness: {cardia: 2 mm, fundus: 2 mm, body: 2 mm, antrum: 2 mm, pylorus: 2 mm}}\n"
          "gas: {insufflator_on: true}\n",
      "balloon.yaml");
}

/// W of a wall whose stretch is s in its plane and c across it.
double energyDensity(double s, double c, double b) {
  const double j = s * s * c, k = 2 * s * s + c * c + j * j - 4 * j;
  return kMu / 2 * (k + b / 2 * k * k) + kLambda / 2 * (j - 1) * (j - 1);
}

/// The stretch across that leaves the wall without stress there, where b is 0: dW/dc = 0 is linear in c.
double freeStretch(double s) {
  const double s2 = s * s, s4 = s2 * s2;
  return s2 * (2 * kMu + kLambda) / (kMu * (1 + s4) + kLambda * s4);
}

/// The same for any b: the least W over c.
double freeStretch(double s, double b) {
  double low = 0.1, high = 3;
  while (high - low > 1e-9) {
    const double left = low + (high - low) / 3, right = high - (high - low) / 3;
    if (energyDensity(s, left, b) < energyDensity(s, right, b)) {
      high = right;
    } else {
      low = left;
    }
  }
  return low;
}

/// Energy of the wall of a balloon that is s times as large as at rest, over the volume of the wall.
double simulatedDensity(const vibe::Model& model, double s) {
  vibe::State state = vibe::initialState(model, 1);
  for (int i = 0; i < model.particle_count; ++i) state.x[i] *= s, state.y[i] *= s, state.z[i] *= s;
  double area = 0;
  for (const double part : model.area) area += part;
  return model.tissue->energy(state) / (area * kThickness);
}

TEST(PolynomialLaw, BalloonHasTheEnergyOfTheClosedForm) {
  const auto model = vibe::buildModel(balloon("polynomial", "0"), "");
  for (const double s : {0.9, 1.1, 1.3, 1.6}) {
    const double exact = energyDensity(s, freeStretch(s), 0);
    EXPECT_NEAR(simulatedDensity(*model, s), exact, kTolerance * exact) << s;
  }
}

TEST(PolynomialLaw, StiffeningIsThatOfTheFormula) {
  const auto model = vibe::buildModel(balloon("polynomial", "2"), "");
  EXPECT_NEAR(freeStretch(1.3, 0.0), freeStretch(1.3), 1e-6);
  for (const double s : {1.1, 1.3, 1.6}) {
    const double exact = energyDensity(s, freeStretch(s, 2), 2);
    EXPECT_NEAR(simulatedDensity(*model, s), exact, kTolerance * exact) << s;
  }
}

// Control: the comparison above tells laws apart.
TEST(PolynomialLaw, AnotherLawHasAnotherEnergy) {
  const auto model = vibe::buildModel(balloon("neo_hookean", "0"), "");
  const double exact = energyDensity(1.6, freeStretch(1.6), 0);
  EXPECT_GT(std::abs(simulatedDensity(*model, 1.6) - exact), 5 * kTolerance * exact);
  const auto stiffer = vibe::buildModel(balloon("polynomial", "0.1"), "");
  EXPECT_GT(std::abs(simulatedDensity(*stiffer, 1.6) - exact), 5 * kTolerance * exact);
}

TEST(PolynomialLaw, BalloonIsInflated) {
  const auto model = vibe::buildModel(balloon("polynomial", "2"), "");
  vibe::State state = vibe::initialState(*model, 1);
  vibe::Workspace workspace(*model);
  std::vector<vibe::Event> events;
  for (int step = 0; step < 120; ++step) vibe::step(*model, state, {}, workspace, events);
  EXPECT_GT(state.volume, 1.02 * model->rest_volume);
  for (const vibe::Event& event : events) EXPECT_NE(event.kind, vibe::Event::Kind::Recovery);
}

}  // namespace
