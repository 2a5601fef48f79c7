// The diaphragm moves the foundation and the entry: amplitude and phase against the driven oscillator, account, bits.
#include "vibe_core/constraints/breathing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/model/accounting.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/simulation/simulation.hpp"
#include "vibe_core/simulation/snapshot.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::breathing_test {
namespace {

using test::icosphere;
using test::plainOrgan;
using test::World;

constexpr double kPi = 3.14159265358979323846;
constexpr double kWall = 2e-3;

// A free ball on springs so soft that it lags behind and swings farther than they do.
Scene softScene(double amplitude) {
  Scene scene;
  scene.tissue.model = "shell";
  scene.tissue.mass_damping = 5;
  scene.tissue.stiffness_damping = 0;
  scene.foundation = FoundationScene{100, true};
  if (amplitude >= 0) scene.breathing = BreathingScene{1, amplitude};
  return scene;
}

World ball(double amplitude, double step = 1.0 / 60) {
  Scene scene = softScene(amplitude);
  scene.step_period = step;
  return World(scene, plainOrgan(icosphere(0.03, 2), kWall));
}

double shiftOf(const World& world, int i) {
  return world.state.z[i] - world.model->organ.surface.vertices[i].z();
}

// Greatest distance of some particles from where a driven oscillator would be in the eighth second, over its amplitude:
//   m x'' = k (d - x) - m c x', with k/m the same for every particle of a wall of one thickness.
double errorOfSwing(double step) {
  World world = ball(0.016, step);
  const Model& model = *world.model;
  const double turn = 2 * kPi * model.scene.breathing->rate, damping = model.scene.tissue.mass_damping;
  const double rate2 = model.scene.foundation->stiffness * model.area[0] / model.mass[0];
  const std::complex<double> response = rate2 / std::complex<double>(rate2 - turn * turn, damping * turn);
  EXPECT_GT(std::abs(response), 1.2);  // control: the answer is not the motion of the springs
  world.run(7);                        // what began with time 0 has faded to e^-17
  double error = 0;
  for (double end = world.state.time + 1; world.state.time < end;) {
    world.step();
    const double swing = std::real(response * std::polar(1.0, turn * world.state.time));
    for (const int i : {0, 5, 100}) error = std::max(error, std::abs(shiftOf(world, i) + 0.008 * (1 - swing)));
  }
  EXPECT_LT(std::abs(energyBalance(model, world.state)), 0.02 * energies(model, world.state).total());
  return error / (0.008 * std::abs(response));
}

TEST(Breathing, aFreeBodySwingsAsADrivenOscillator) {
  const double coarse = errorOfSwing(1.0 / 60), fine = errorOfSwing(1.0 / 240);
  EXPECT_LT(coarse, 0.015);
  EXPECT_LT(fine, 0.3 * coarse);
}

TEST(Breathing, shiftAndSpeedAreThoseOfTheFormula) {
  const BreathingScene breathing{0.25, 0.02};
  EXPECT_TRUE(breathingShift(breathing, 0).isZero());
  EXPECT_NEAR(breathingShift(breathing, 2).z(), -0.02, 1e-15);
  EXPECT_NEAR(breathingShift(breathing, 4).z(), 0, 1e-15);
  const double step = 1e-6, slope = (breathingShift(breathing, 1.3 + step) - breathingShift(breathing, 1.3)).z() / step;
  EXPECT_NEAR(breathingSpeed(breathing, 1.3).z(), slope, 1e-7);
}

TEST(Breathing, offIsTheSameToTheBit) {
  World without = ball(-1), still = ball(0), with = ball(1e-6);
  without.run(0.5), still.run(0.5), with.run(0.5);
  EXPECT_EQ(hash(without.state), hash(still.state));
  EXPECT_NE(hash(without.state), hash(with.state));
}

TEST(Breathing, theEntryFollowsAndTheDuodenumDoesNot) {
  Scene scene = loadScene(resolveAddress("package://vibe_core/scenes/stomach.yaml"));
  scene.geometry.particles = 300;
  scene.render_surface = false;
  scene.breathing = BreathingScene{0.5, 0.016};
  const auto model = buildModel(scene, readTextFile(resolveAddress(scene.scope->urdf), "URDF"));
  Simulation simulation(model);
  StepInput input;
  input.buttons[Insufflate] = 1;
  for (int k = 0; k < 60; ++k) simulation.step(input);
  const std::string before = encodeSnapshot(*model, simulation.state());
  for (int k = 0; k < 60; ++k) {
    simulation.step(input);
    const double shift = breathingShift(*scene.breathing, simulation.time()).z();
    const State& state = simulation.state();
    for (int i = 0; i < model->particle_count; ++i) {
      const double moved = state.z[i] - model->organ.surface.vertices[i].z();
      const bool entry = model->organ.end[i] == End::Oesophagus;
      if (entry || model->organ.end[i] == End::Duodenum) {
        EXPECT_NEAR(moved, entry ? shift : 0, 1e-12);
      }
    }
  }
  Simulation again(model);
  again.replaceState(decodeSnapshot(*model, before, "test"));
  for (int k = 0; k < 60; ++k) again.step(input);
  EXPECT_EQ(again.hash(), simulation.hash());
}

TEST(Breathing, shapeMatchingRefusesIt) {
  Scene scene = softScene(0.01);
  scene.tissue.model = "shape_matching";
  EXPECT_THROW(World(scene, plainOrgan(icosphere(0.03, 1), kWall)), Error);
  scene.breathing.reset();
  EXPECT_NO_THROW(World(scene, plainOrgan(icosphere(0.03, 1), kWall)));
}

}  // namespace
}  // namespace vibe::breathing_test
