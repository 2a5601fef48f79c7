// A wall whose stress relaxes: the series of walls that are held, the hereditary integral, limits, account and bits.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "constraints/blocks.hpp"
#include "tissue/shell_tissue.hpp"
#include "vibe_core/model/accounting.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/simulation/snapshot.hpp"
#include "vibe_testing/expect_error.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::relaxation_test {
namespace {

using test::icosphere;
using test::plainOrgan;
using test::World;

constexpr double kRadius = 0.05, kWall = 2e-3;

Scene wallScene(const RelaxationScene& relaxation, double step = 1.0 / 60) {
  Scene scene;
  scene.step_period = step;
  scene.tissue.young_modulus = 60e3;
  scene.tissue.relaxation = relaxation;
  return scene;
}

World ball(const Scene& scene) {
  return World(scene, plainOrgan(icosphere(kRadius, 2), kWall));
}

/// A ball whose particles are led: the block sees steps without a solver.
class Led {
 public:
  Led(const RelaxationScene& relaxation, double step)
      : world_(ball(wallScene(relaxation, step))),
        shell_(*dynamic_cast<const ShellTissue&>(*world_.model->tissue).elements()),
        block_(makeRelaxationBlock(*world_.model)),
        step_(step) {}

  /// One step, at whose end each particle is at the linear image of its place at rest.
  void lead(const Eigen::Matrix3d& image, const Eigen::Vector3d& shift = Eigen::Vector3d::Zero()) {
    State& state = world_.state;
    const StepContext context{*world_.model, state, step_, nullptr, false};
    BodyLoads loads;
    std::vector<ToolTouch> touches;
    block_->begin(context, loads);
    for (int i = 0; i < world_.model->particle_count; ++i) {
      const Eigen::Vector3d at = image * world_.model->organ.surface.vertices[i] + shift;
      state.x[i] = at.x(), state.y[i] = at.y(), state.z[i] = at.z();
    }
    block_->store(context, loads, touches);
  }
  void stretch(double stretch) { lead(stretch * Eigen::Matrix3d::Identity()); }

  /// What the membrane pulls back with against a stretch of the ball, 3 V / stretch times its pressure [J].
  double pull(bool elastic = false) const {
    const RelaxationMemory& memory = world_.state.relaxation;
    const RelaxationScene& relaxation = *world_.model->scene.tissue.relaxation;
    std::vector<float> stress = memory.stress;
    const double kept = elastic ? 1 : 1 - relaxingShare(relaxation);
    for (std::size_t i = 0; i < stress.size(); ++i) {
      double sum = kept * stress[i];
      for (std::size_t k = 0; !elastic && k < relaxation.ratios.size(); ++k)
        sum += memory.overstress[k * stress.size() + i];
      stress[i] = static_cast<float>(sum);
    }
    const std::vector<Eigen::Vector3d>& rest = shell_.mesh().nodes;
    std::vector<float> u(4 * rest.size(), 0), gradient(u);
    for (std::size_t i = 0; i < rest.size(); ++i)
      for (int k = 0; k < 3; ++k)
        u[4 * i + k] = static_cast<float>(world_.position(static_cast<int>(i))[k] - rest[i][k]);
    shell_.stressWork(stress.data(), u.data(), gradient.data());
    double sum = 0;
    for (std::size_t i = 0; i < rest.size(); ++i)
      for (int k = 0; k < 3; ++k) sum += gradient[4 * i + k] * rest[i][k];
    return sum;
  }
  const RelaxationMemory& memory() const { return world_.state.relaxation; }
  double held() const { return std::accumulate(memory().held.begin(), memory().held.end(), 0.0); }

 private:
  World world_;
  const ShellElements& shell_;
  std::unique_ptr<ConstraintBlock> block_;
  double step_;
};

double reduced(const RelaxationScene& relaxation, double time) {
  double sum = 1 - relaxingShare(relaxation);
  for (std::size_t k = 0; k < relaxation.ratios.size(); ++k)
    sum += relaxation.ratios[k] * std::exp(-time / relaxation.times[k]);
  return sum;
}

TEST(Relaxation, thePressureOfABallThatIsHeldFallsAsTheSeries) {
  const RelaxationScene relaxation{{0.3, 0.2}, {0.5, 5}};
  const double step = 1.0 / 60;
  Led led(relaxation, step);
  led.stretch(1.1);
  const double at_once = led.pull(true);
  for (int n = 1; n <= 20 * 60; ++n) {
    led.stretch(1.1);
    const double share = led.pull() / at_once, time = (n + 0.5) * step;  // since the middle of the stretch
    ASSERT_NEAR(share, reduced(relaxation, time), 1e-4) << time;
    const double other = reduced({{0.3, 0.2}, {1, 5}}, time);
    ASSERT_TRUE(n != 60 || std::abs(share - other) > 0.05) << share;  // control
  }
  EXPECT_NEAR(led.memory().loss, 0.5 * led.memory().energy, 0.01 * led.memory().energy);
  EXPECT_NEAR(led.held(), 0, 1e-3 * led.memory().energy);
}

// Stretched to and fro for four seconds, with the step as the only error.
double pullAfterSwing(double step) {
  Led led({{0.4}, {0.5}}, step);
  for (int n = 1; n <= std::lround(4 / step); ++n) led.stretch(1 + 0.1 * std::sin(3 * n * step));
  return led.pull();
}

TEST(Relaxation, theIntegralIsOfSecondOrderInTheStep) {
  const double exact = pullAfterSwing(1.0 / 1920);
  const double coarse = std::abs(pullAfterSwing(1.0 / 60) / exact - 1),
               fine = std::abs(pullAfterSwing(1.0 / 240) / exact - 1);
  RecordProperty("coarse", std::to_string(coarse));
  RecordProperty("fine", std::to_string(fine));
  EXPECT_LT(coarse, 1e-3);
  EXPECT_LT(fine, coarse / 8);
}

TEST(Relaxation, aRigidMotionLeavesTheStressAsItIs) {
  const RelaxationScene relaxation{{0.5}, {2}};
  Led still(relaxation, 1.0 / 60), moved(relaxation, 1.0 / 60), stretched(relaxation, 1.0 / 60);
  const Eigen::Matrix3d shape = Eigen::Vector3d(1.2, 1.05, 0.95).asDiagonal();
  for (int n = 0; n < 60; ++n) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.05 * n, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
    still.lead(shape);
    moved.lead(turn * shape, 0.001 * n * Eigen::Vector3d(1, -1, 2));
    stretched.lead((1 + 1e-3 * n) * shape);
  }
  const auto difference = [&](const Led& other) {
    double most = 0, greatest = 0;
    for (std::size_t i = 0; i < still.memory().overstress.size(); ++i) {
      const double here = still.memory().overstress[i];
      greatest = std::max(greatest, std::abs(here));
      most = std::max(most, std::abs(other.memory().overstress[i] - here));
    }
    return most / greatest;
  };
  EXPECT_LT(difference(moved), 1e-4);
  EXPECT_GT(difference(stretched), 0.05);  // control
}

// The work that leads the ball is what the wall stores and what it loses, whatever the way.
TEST(Relaxation, theAccountOfALedWallCloses) {
  Led led({{0.3, 0.3}, {0.2, 2}}, 1.0 / 240);
  double work = 0, before = 1, pull = 0;
  led.stretch(1);
  for (int n = 1; n <= 960; ++n) {
    const double stretch = n < 480 ? 1 + 0.15 * std::abs(std::sin(0.02 * n)) : 1 + 0.15 * std::abs(std::sin(9.6));
    led.stretch(stretch);
    const double now = led.pull();
    work += (now + pull) / 2 * (stretch - before);
    before = stretch, pull = now;
  }
  const double stored = (1 - 0.6) * led.memory().energy + led.held();
  EXPECT_NEAR(work, stored + led.memory().loss, 0.01 * work);  // what relaxes within a step acts in the next
  EXPECT_GT(led.memory().loss, 0.2 * work);                    // control: without it the account is open
}

Scene inflated(double young_modulus) {
  Scene scene = wallScene({{0.3, 0.2}, {0.3, 1}});
  scene.tissue.young_modulus = young_modulus;
  scene.gas.emplace();
  scene.gas->regulated_pressure = 300;
  scene.gas->insufflator_on = true;
  return scene;
}

double volumeOf(Scene scene, double seconds) {
  World world = ball(scene);
  world.run(seconds);
  return world.state.volume / world.model->rest_volume - 1;
}

TEST(Relaxation, inTheEndTheWallIsThatOfTheRelaxedModulus) {
  Scene hard = inflated(60e3), soft = inflated(30e3);
  hard.tissue.relaxation.reset(), soft.tissue.relaxation.reset();
  const double found = volumeOf(inflated(60e3), 12);
  EXPECT_NEAR(found, volumeOf(soft, 12), 1e-3 * found);
  EXPECT_LT(volumeOf(hard, 12), 0.6 * found);  // control
}

TEST(Relaxation, creepDoesNotDependOnTheStep) {
  Scene scene = inflated(60e3);
  const double coarse = volumeOf(scene, 1);
  scene.step_period = 1.0 / 240;
  const double fine = volumeOf(scene, 1);
  RecordProperty("difference", std::to_string(coarse / fine - 1));
  EXPECT_NEAR(coarse, fine, 3e-3 * fine);
  EXPECT_GT(volumeOf(inflated(60e3), 3), 1.05 * coarse);  // control: it is not over yet
}

TEST(Relaxation, theAccountCloses) {
  Scene scene = inflated(60e3);
  World world = ball(scene);
  world.run(3);
  world.state.gas_amount *= 0.99;  // lets out some gas
  world.run(1);
  const double work = std::abs(world.state.energy.gas_work);
  EXPECT_LT(std::abs(energyBalance(*world.model, world.state)), 1e-3 * work);
  EXPECT_GT(world.state.relaxation.loss, 0.02 * work);
  RecordProperty("balance", std::to_string(energyBalance(*world.model, world.state) / work));
}

TEST(Relaxation, aSnapshotGoesOnWithTheSameBits) {
  World world = ball(inflated(60e3));
  world.run(0.5);
  State again = decodeSnapshot(*world.model, encodeSnapshot(*world.model, world.state), "snapshot");
  State without = again;
  ASSERT_FALSE(again.relaxation.stress.empty());
  without.relaxation = {};
  Workspace fresh(*world.model, 2);
  const auto go = [&](State& state) {
    for (int n = 0; n < 30; ++n) step(*world.model, state, {}, fresh, world.events);
    return hash(state);
  };
  world.run(0.5);
  EXPECT_EQ(hash(world.state), go(again));
  EXPECT_NE(hash(world.state), go(without));  // control
  again.relaxation.overstress.pop_back();
  EXPECT_ERROR(decodeSnapshot(*world.model, encodeSnapshot(*world.model, again), "snapshot"), "relaxed");
}

TEST(Relaxation, anElasticWallHasNoPast) {
  Scene scene = inflated(60e3);
  scene.tissue.relaxation.reset();
  World world = ball(scene);
  world.run(0.1);
  EXPECT_TRUE(world.state.relaxation.stress.empty());
}

TEST(Relaxation, badSeriesAreRefusedInOneSentence) {
  const auto parse = [](const std::string& keys) { return parseScene("tissue: {" + keys + "}\n", "s.yaml"); };
  EXPECT_EQ(parse("relaxation: {ratios: [0.2], times: [2 min]}").tissue.relaxation->times[0], 120);
  EXPECT_EQ(parse("relaxation: {}").tissue.relaxation->ratios.size(), 2U);
  EXPECT_ERROR(parse("relaxation: {ratios: [0.2, 0.1], times: [1]}"), "has 2 ratios and 1 times; write one time per");
  EXPECT_ERROR(parse("relaxation: {ratios: [0.6, 0.5], times: [1, 2]}"), "which leaves no stress");
  EXPECT_ERROR(parse("relaxation: {ratios: [], times: []}"), "has 0 terms");
  EXPECT_ERROR(parse("relaxation: {ratios: [0.5], times: [0.01]}"), "five steps");
  EXPECT_ERROR(parse("relaxation: {ratios: [-0.5], times: [1]}"), "ratios[0]");
  EXPECT_ERROR(parse("relaxation: {ratios: [.nan], times: [1]}"), "ratios[0]");
  EXPECT_ERROR(parse("relaxation: {ratios: 0.5, times: [1]}"), "list");
  EXPECT_ERROR(parse("relaxation: {ratios: [0.5], times: [1 mm]}"), "times[0]");
  EXPECT_ERROR(parse("relaxation: {tau: [1]}"), "is not a known key");
  EXPECT_ERROR(parse("model: shape_matching, relaxation: {}"), "model: shell");
}

}  // namespace
}  // namespace vibe::relaxation_test
