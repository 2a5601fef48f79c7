#include "vibe_example_constraint/tether.hpp"

#include <gtest/gtest.h>

#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/constraints/constraint_registry.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/simulation/simulator.hpp"

namespace {

using Eigen::Vector3d;

constexpr int kParticle = 17;
constexpr double kStiffness = 40, kFoundation = 5e3;

class TetherTest : public ::testing::Test {
 protected:
  const std::shared_ptr<const vibe::Model> model_ = vibe::buildModel(
      vibe::parseScene("geometry: {kind: sphere, particles: 400, radius: 3 cm}\nfoundation: {stiffness: 5 kPa/m}\n",
                       "sphere.yaml"),
      "");
  vibe::State state_ = vibe::initialState(*model_, 1);

  ~TetherTest() override {
    if (vibe::constraintNames().back() == "tether") vibe::unregisterConstraint("tether");
  }

  const Vector3d& rest(int i) const { return model_->organ.surface.vertices[i]; }
  Vector3d position(int i) const { return {state_.x[i], state_.y[i], state_.z[i]}; }
  Tether tether() const { return {kParticle, 1.2 * rest(kParticle), kStiffness}; }

  void run(double seconds) {
    vibe::Workspace workspace(*model_);
    std::vector<vibe::Event> events;
    while (state_.time < seconds) vibe::step(*model_, state_, {}, workspace, events);
  }

  /// Of the springs that hold the wall in place.
  Vector3d foundationForce() const {
    Vector3d sum = Vector3d::Zero();
    for (int i = 0; i < model_->particle_count; ++i) sum -= kFoundation * model_->area[i] * (position(i) - rest(i));
    return sum;
  }
};

// At rest nothing but the foundation resists the tether.
TEST_F(TetherTest, PullsWithHookesForceAtEquilibrium) {
  registerTether(tether());
  run(3);
  const Vector3d force = kStiffness * (tether().end - position(kParticle));
  EXPECT_GT(force.norm(), 0.02);
  EXPECT_LT((force + foundationForce()).norm(), 0.01 * force.norm());
}

TEST_F(TetherTest, ItsWorkIsTheEnergyThatTheSpringHasLost) {
  registerTether(tether());
  run(1);
  const double before = (tether().end - rest(kParticle)).squaredNorm();
  const double after = (tether().end - position(kParticle)).squaredNorm();
  EXPECT_GT(state_.energy.pull_work, 1e-6);
  EXPECT_NEAR(state_.energy.pull_work, kStiffness / 2 * (before - after), 1e-12);
}

// Control.
TEST_F(TetherTest, WithoutItNothingMoves) {
  run(1);
  EXPECT_LT((position(kParticle) - rest(kParticle)).norm(), 1e-6);
  EXPECT_EQ(state_.energy.pull_work, 0);
}

TEST_F(TetherTest, ThereIsOneAtMost) {
  registerTether(tether());
  EXPECT_THROW(registerTether(tether()), vibe::Error);
}

}  // namespace
