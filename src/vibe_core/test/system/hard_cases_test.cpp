// States and loads that no tissue should meet, through the whole simulator: numbers stay numbers, and once nothing acts
// the organ comes back to its shape.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>

#include "vibe_core/builder/tissue_registry.hpp"
#include "vibe_testing/scope_worlds.hpp"

namespace vibe::hard_cases_test {
namespace {

using test::icosphere;
using test::plainOrgan;
using test::World;

constexpr double kRadius = 0.05, kWall = 2.3e-3;

/// The default wall on a foundation, as every shipped scene has it.
Scene hardScene() {
  Scene scene;
  scene.tissue.model = "shell";
  scene.foundation = FoundationScene{};
  return scene;
}

Organ ball() {
  return plainOrgan(icosphere(kRadius, 3), kWall);
}

double lengthOf(const Model& model) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : model.organ.surface.vertices) box.extend(p);
  return box.sizes().maxCoeff();
}

/// Root of the mean squared distance of the particles from their places at rest, over the length of the organ.
double errorOf(const Model& model, const State& state) {
  double sum = 0;
  for (int i = 0; i < model.particle_count; ++i)
    sum += (Eigen::Vector3d(state.x[i], state.y[i], state.z[i]) - model.organ.surface.vertices[i]).squaredNorm();
  return std::sqrt(sum / model.particle_count) / lengthOf(model);
}

void place(State& state, const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& where) {
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    const Eigen::Vector3d p = where({state.x[i], state.y[i], state.z[i]});
    state.x[i] = p.x(), state.y[i] = p.y(), state.z[i] = p.z();
  }
}

/// Steps, and watches every one of them for numbers that are none or run away.
void runWatched(World& world, double seconds, double max = 100) {
  const long steps = std::lround(seconds / world.model->scene.step_period);
  for (long s = 0; s < steps; ++s) {
    world.step();
    for (const auto* v : {&world.state.x, &world.state.y, &world.state.z})
      for (double value : *v) ASSERT_LT(std::abs(value), max) << "after " << world.state.time << " s";
  }
}

void expectHealed(World& world, double seconds = 2, double limit = 1e-3) {
  runWatched(world, seconds);
  const double error = errorOf(*world.model, world.state);
  ::testing::Test::RecordProperty("error_over_length", std::to_string(error));
  EXPECT_LT(error, limit);
}

void dent(World& world) {
  place(world.state, [](const Eigen::Vector3d& p) { return Eigen::Vector3d(p.x(), p.y(), std::min(p.z(), 0.01)); });
}

struct Start {
  const char* name;
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> where;
};

std::function<Eigen::Vector3d(const Eigen::Vector3d&)> randomInBox() {
  auto generator = std::make_shared<std::mt19937>(7);
  return [generator](const Eigen::Vector3d&) {
    std::uniform_real_distribution<double> uniform(-kRadius, kRadius);
    const double x = uniform(*generator), y = uniform(*generator), z = uniform(*generator);
    return Eigen::Vector3d(x, y, z);
  };
}

std::vector<Start> badStarts() {
  using V = Eigen::Vector3d;
  return {{"random", randomInBox()},
          {"plane", [](const V& p) { return V(p.x(), p.y(), 0); }},
          {"line", [](const V& p) { return V(p.x(), 0, 0); }},
          {"point", [](const V&) { return V(0, 0, 0); }},
          {"mirrored", [](const V& p) { return V(-p.x(), p.y(), p.z()); }},
          {"inside_out", [](const V& p) { return V(-p); }},
          {"thrice_as_long", [](const V& p) { return V(3 * p.x(), p.y(), p.z()); }},
          {"thrice_as_large", [](const V& p) { return V(3 * p); }}};
}

class BadStart : public ::testing::TestWithParam<std::tuple<int, const char*>> {};

TEST_P(BadStart, HealsWithinTwoSeconds) {
  const auto [which, law] = GetParam();
  const Start start = badStarts()[static_cast<std::size_t>(which)];
  Scene scene = hardScene();
  scene.tissue.law = law;
  World world(scene, ball());
  place(world.state, start.where);
  ASSERT_GT(errorOf(*world.model, world.state), 0.1);
  expectHealed(world);
  // elasticity alone would rest in another shape: dented, everted or tangled
  EXPECT_EQ(world.count(Event::Kind::Recovery), 1);
}

std::string nameOf(const ::testing::TestParamInfo<BadStart::ParamType>& info) {
  return badStarts()[static_cast<std::size_t>(std::get<0>(info.param))].name + std::string("_") +
         std::get<1>(info.param);
}

INSTANTIATE_TEST_SUITE_P(Hard, BadStart, ::testing::Combine(::testing::Range(0, 8), ::testing::Values("fung", "yeoh")),
                         nameOf);

class LongStep : public ::testing::TestWithParam<double> {};

TEST_P(LongStep, FreeShapeComesBackFromADent) {
  Scene scene = hardScene();
  scene.step_period = GetParam();
  World world(scene, ball());
  dent(world);
  ASSERT_GT(errorOf(*world.model, world.state), 0.05);
  expectHealed(world);
}

INSTANTIATE_TEST_SUITE_P(Hard, LongStep, ::testing::Values(1.0 / 30, 0.1));

TEST(Hard, AThousandTimesStiffer) {
  Scene scene = hardScene();
  scene.tissue.young_modulus *= 1000;
  World world(scene, ball());
  dent(world);
  expectHealed(world);
}

TEST(Hard, MassesOfOneToTenThousand) {
  auto model = std::make_shared<Model>();
  model->scene = hardScene();
  model->organ = ball();
  finishModel("", *model);
  for (int i = 0; i < model->particle_count; i += 2) model->mass[i] *= 1e-4, model->inverse_mass[i] *= 1e4;
  const TissueAndSolver made = makeTissue(model->scene, model->organ, model->mass, model->area);
  model->tissue = made.tissue, model->solver = made.solver;
  World world(hardScene(), ball());
  world.model = model;
  world.workspace = std::make_unique<Workspace>(*model);
  dent(world);
  expectHealed(world);
}

TEST(Hard, AThousandfoldGravityAndThenNone) {
  Scene heavy = hardScene();
  heavy.gravity = GravityScene{{-9810, 0, 0}};
  heavy.foundation->carries_weight = false;
  World crushed(heavy, ball());
  runWatched(crushed, 1);
  EXPECT_GT(errorOf(*crushed.model, crushed.state), 0.1);
  World world(hardScene(), ball());
  world.state = crushed.state;
  expectHealed(world);
}

TEST(Hard, PressureBeyondTheLimitPoint) {
  Scene scene = hardScene();
  scene.tissue.law = "neo_hookean";
  scene.foundation->stiffness = 100;
  scene.gas = GasScene{};
  scene.gas->insufflator_on = true;
  scene.gas->flow_limit = 1e-2;
  // p = 2 mu t / R (s^-1 - s^-7) of a neo-Hookean balloon has its greatest value, 0.62 of 2 mu t / R, at s = 1.38
  const double mu = scene.tissue.young_modulus / (2 * (1 + scene.tissue.poisson_ratio));
  scene.gas->regulated_pressure = 2 * 2 * mu * kWall / kRadius;
  World world(scene, ball());
  runWatched(world, 3);
  EXPECT_GE(world.count(Event::Kind::Recovery), 1) << "no equilibrium is there, and it says so";
  EXPECT_LT(world.state.volume, 64 * world.model->rest_volume);
  EXPECT_TRUE(std::isfinite(world.state.pressure));
}

/// Pressure in a thin sphere of the neo-Hookean law whose radius has grown by a factor, over 2 t / R: dU/dV of
/// W = mu/2 (I - 3) - mu ln J + lambda/2 ln^2 J, stretched equally in the plane and free in thickness.
double spherePressure(double mu, double lambda, double stretch) {
  double low = 0.1, high = 2;  // stretch s of the thickness: mu (s^2 - 1) + lambda ln(stretch^2 s) = 0
  for (int i = 0; i < 60; ++i) {
    const double s = 0.5 * (low + high);
    (mu * (s * s - 1) + lambda * std::log(stretch * stretch * s) > 0 ? high : low) = s;
  }
  const double log_volume = std::log(stretch * stretch * low);
  return (mu * (stretch - 1 / stretch) + lambda * log_volume / stretch) / (stretch * stretch);
}

double limitPressure(const TissueScene& tissue, double thickness) {
  const double e = tissue.young_modulus, nu = tissue.poisson_ratio;
  double max = 0;
  for (double stretch = 1; stretch < 2; stretch += 1e-3)
    max = std::max(max, spherePressure(e / (2 * (1 + nu)), e * nu / ((1 + nu) * (1 - 2 * nu)), stretch));
  return 2 * thickness / kRadius * max;
}

/// A ball that is filled slowly to a part of its limit pressure or, with a stiffening law, to any pressure.
World filledBall(const char* law, double pressure_over_limit) {
  Scene scene = hardScene();
  scene.tissue.law = law;
  scene.foundation->stiffness = 1;  // knows where to be
  scene.gas = GasScene{};
  scene.gas->insufflator_on = true;
  scene.gas->flow_limit = 3e-4;
  scene.gas->regulated_pressure = pressure_over_limit * limitPressure(scene.tissue, kWall);
  return World(scene, ball());
}

/// The gas reaches its pressure and holds the wall, which stretches by more than `stretch` and is left alone.
void expectHeldByItsGas(const char* law, double pressure_over_limit, double stretch) {
  SCOPED_TRACE(law + (" at " + std::to_string(pressure_over_limit)));
  World world = filledBall(law, pressure_over_limit);
  runWatched(world, 20);
  EXPECT_EQ(world.count(Event::Kind::Recovery), 0);
  EXPECT_EQ(world.count(Event::Kind::PressureReached), 1);
  EXPECT_GT(std::cbrt(world.state.volume / world.model->rest_volume), stretch);
}

TEST(Hard, AStableWallBelowItsLimitPressureIsLeftAlone) {
  expectHeldByItsGas("neo_hookean", 0.92, 1.2);
  expectHeldByItsGas("neo_hookean", 0.98, 1.27);
}

TEST(Hard, AWallThatBurstsIsLedBack) {
  World world = filledBall("neo_hookean", 1.05);
  runWatched(world, 20, 10);
  EXPECT_GE(world.count(Event::Kind::Recovery), 1);
}

TEST(Hard, AStiffeningWallMayStretchAsFarAsItsGasHoldsIt) {
  expectHeldByItsGas("yeoh", 2, 1.2);
  expectHeldByItsGas("yeoh", 6, 1.51);
}

TEST(Hard, InsufflationIsNothingUnusual) {
  Scene scene = hardScene();
  scene.gas = GasScene{};
  scene.gas->insufflator_on = true;
  scene.gas->flow_limit = 1e-3;
  World world(scene, ball());
  runWatched(world, 2);
  EXPECT_EQ(world.count(Event::Kind::PressureReached), 1);
  EXPECT_EQ(world.count(Event::Kind::Recovery), 0);
}

TEST(Hard, TurnedInsideOutOnTheWayIsNoticed) {
  World world(hardScene(), ball());
  dent(world);
  runWatched(world, 0.1);
  ASSERT_EQ(world.count(Event::Kind::Recovery), 0);
  place(world.state, [](const Eigen::Vector3d& p) { return Eigen::Vector3d(-p); });
  expectHealed(world);
  EXPECT_EQ(world.count(Event::Kind::Recovery), 1);
}

TEST(Hard, NeedleThinTriangles) {
  Organ thin = plainOrgan(icosphere(kRadius, 3), kWall);
  for (std::size_t i = 0; i < thin.surface.vertices.size(); ++i) {
    Eigen::Vector3d& p = thin.surface.vertices[i];
    p.z() = kRadius * std::asin(std::clamp(p.z() / kRadius, -1.0, 1.0)) * 4;  // a cigar
    p.x() *= 0.05, p.y() *= 0.05;
  }
  World cigar(hardScene(), thin);
  place(cigar.state, [](const Eigen::Vector3d& p) { return Eigen::Vector3d(p.x(), p.y() + 0.3 * p.z(), 0.5 * p.z()); });
  expectHealed(cigar);
}

/// A ball with the scope entering at the top and looking down.
World scopeWorld() {
  Scene scene = hardScene();
  scene.scope = test::scopeFromAbove(kRadius);
  scene.helix = test::firmHelix();
  return test::scopeWorld(scene, test::openBall(kRadius, 3, kWall));
}

TEST(Hard, GripPulledByFortyMillimetresInOneFrame) {
  for (const int held : {40, 100, 178, 270, 431, 592}) {
    World world = scopeWorld();
    std::vector<Eigen::Isometry3d> poses;
    world.model->tool->forwardKinematics(world.state.joints, poses);
    const Eigen::Isometry3d helix = world.model->tool_base * poses[world.model->grip_link];
    const Eigen::Vector3d p = world.position(held);
    world.state.grip = {{held, helix.inverse() * Eigen::Vector3d(p - 0.04 * p.normalized())}};
    world.state.helix_pressed = true;
    StepInput hold;
    hold.buttons[HelixGrab] = 1;
    world.step(hold);  // its work is limited: it says what it leaves, and the next one goes on
    EXPECT_FALSE(world.workspace->report().arrived);
    EXPECT_GT(world.workspace->report().residual, 1e-3);
    world.step(hold);
    EXPECT_NEAR((world.position(held) - p).norm(), 0.04, 1e-6) << held;
    world.run(0.2, hold);  // it slips by itself above its hold force
    expectHealed(world);
    EXPECT_EQ(world.count(Event::Kind::Recovery), 0) << held;
  }
}

TEST(Hard, ToolThroughTheWallInOneFrame) {
  World world = scopeWorld();
  world.state.joints[Insertion] = 0.15;  // 5 cm beyond the wall opposite
  StepInput there;
  there.joints[Insertion] = 0.15;
  world.run(1, there);
  ASSERT_LT(errorOf(*world.model, world.state), 1);
  world.state.joints[Insertion] = 0;
  expectHealed(world);
  EXPECT_EQ(world.count(Event::Kind::Recovery), 0);
}

}  // namespace
}  // namespace vibe::hard_cases_test
