// A constraint that a program adds by itself, without a change in the library: a tether, which pulls one particle
// towards a fixed point as a linear spring.
#include <gtest/gtest.h>

#include <algorithm>

#include "vibe_core/constraints/constraint_registry.hpp"
#include "vibe_core/model/accounting.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/solver/energy_term.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::registered_block_test {
namespace {

using test::icosphere;
using test::plainOrgan;
using test::World;

constexpr int kParticle = 17;
constexpr double kStiffness = 40;  // of the tether [N/m]
constexpr double kRadius = 0.03, kWall = 2e-3;

// Everything that a new constraint needs: this class and one call of registerConstraint(). The fixed end starts at the
// particle's rest position and is drawn to its place within a second, slowly, so that little is lost to damping.
class Tether : public ConstraintBlock {
 public:
  Tether(int particle, Eigen::Vector3d rest, Eigen::Vector3d end)
      : particle_{particle}, rest_(std::move(rest)), end_(std::move(end)) {}

  Activity prepare(const StepContext& context, BodyLoads& loads) override {
    first_ = loads.addPoint(particle_, weight_, endAt(context.state.time + context.step), 1 / kStiffness);
    start_ = place(context.state);
    return Activity::Disturb;
  }

  // Work by the trapezoidal rule.
  double store(const StepContext& context, const BodyLoads& loads, std::vector<ToolTouch>&) override {
    const Eigen::Vector3d now = place(context.state);
    const Eigen::Vector3d before = kStiffness * (endAt(context.state.time) - start_);
    const Eigen::Vector3d after = kStiffness * (endAt(context.state.time + context.step) - now);
    context.state.energy.pull_work += 0.5 * (before + after).dot(now - start_);
    force_ = loads.pointForce(first_);
    return 0;
  }

  Eigen::Vector3d force() const { return force_; }

 private:
  Eigen::Vector3d endAt(double time) const { return rest_ + std::min(1.0, time) * (end_ - rest_); }
  Eigen::Vector3d place(const State& state) const {
    const int i = particle_[0];
    return {state.x[i], state.y[i], state.z[i]};
  }

  std::vector<int> particle_;
  std::vector<double> weight_{1};
  Eigen::Vector3d rest_, end_, start_ = Eigen::Vector3d::Zero();
  std::size_t first_ = 0;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();  // for the test
};

// The same as an energy, which needs no row.
class TetherEnergy : public ConstraintBlock, public EnergyTerm {
 public:
  explicit TetherEnergy(Eigen::Vector3d end) : end_(std::move(end)) {}
  Activity prepare(const StepContext&, BodyLoads&) override { return Activity::Disturb; }
  const EnergyTerm* energyTerm(const StepContext&) override { return this; }
  bool acts() const override { return false; }
  double evaluate(const double* positions4, float* gradient4) const override {
    const Eigen::Vector3d away = Eigen::Map<const Eigen::Vector3d>(positions4 + 4 * kParticle) - end_;
    for (int k = 0; k < 3; ++k) gradient4[4 * kParticle + k] += static_cast<float>(kStiffness * away[k]);
    return 0.5 * kStiffness * away.squaredNorm();
  }

 private:
  Eigen::Vector3d end_;
};

// The same in a solver that divides the step.
class TetherSubsteps : public ConstraintBlock, public SubstepLoad {
 public:
  explicit TetherSubsteps(Eigen::Vector3d end) : end_(std::move(end)) {}
  Activity prepare(const StepContext&, BodyLoads&) override { return Activity::Disturb; }
  SubstepLoad* substepLoad() override { return this; }
  void prepareSubsteps(const Model&, State&) override {}
  void reportSubsteps(int, State&) override {}
  void apply(const Model& model, double substep, State& state) override {
    const int i = kParticle;
    const double give = substep * substep * model.inverse_mass[i], stiffness = kStiffness / (1 + kStiffness * give);
    const Eigen::Vector3d by = give * stiffness * (end_ - Eigen::Vector3d(state.x[i], state.y[i], state.z[i]));
    state.x[i] += by.x(), state.y[i] += by.y(), state.z[i] += by.z();
    state.vx[i] += by.x() / substep, state.vy[i] += by.y() / substep, state.vz[i] += by.z() / substep;
  }

 private:
  Eigen::Vector3d end_;
};

Scene sphereScene(const std::string& model = "shell") {
  Scene scene;
  scene.tissue.model = model;
  scene.tissue.mass_damping = 20;
  scene.foundation = FoundationScene{};
  return scene;
}

World sphere(const std::string& model = "shell") {
  return World(sphereScene(model), plainOrgan(icosphere(kRadius, 2), kWall));
}

Eigen::Vector3d restOf(const Model& model) {
  return model.organ.surface.vertices[kParticle];
}

Eigen::Vector3d endOf(const Model& model) {
  return 1.2 * restOf(model);
}

std::unique_ptr<ConstraintBlock> makeTether(const Model& model) {
  return std::make_unique<Tether>(kParticle, restOf(model), endOf(model));
}

// What the foundation bears is what the tether pulls: nothing else acts on the sphere from outside.
Eigen::Vector3d foundationForce(const World& world) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < world.model->particle_count; ++i)
    sum -= world.model->scene.foundation->stiffness * world.model->area[i] *
           (world.position(i) - world.model->organ.surface.vertices[i]);
  return sum;
}

class RegisteredBlock : public testing::Test {
 protected:
  void add(ConstraintFactory factory) {
    registerConstraint("tether", std::move(factory));
    added_ = true;
  }
  void TearDown() override {
    if (added_) unregisterConstraint("tether");
  }

 private:
  bool added_ = false;
};

TEST_F(RegisteredBlock, theTetherBearsWhatItsLengthSaysAtEquilibrium) {
  const Tether* tether = nullptr;
  add([&tether](const Model& model) {
    auto made = std::make_unique<Tether>(kParticle, restOf(model), endOf(model));
    tether = made.get();
    return made;
  });
  World world = sphere();
  world.run(3);
  const Eigen::Vector3d hooke = kStiffness * (endOf(*world.model) - world.position(kParticle));
  EXPECT_GT(hooke.norm(), 0.02);
  EXPECT_LT((tether->force() - hooke).norm(), 1e-3 * hooke.norm());
  EXPECT_LT((hooke + foundationForce(world)).norm(), 0.01 * hooke.norm());
  EXPECT_GT((world.position(kParticle) - restOf(*world.model)).norm(), 1e-4) << "the tether moves the wall";
}

TEST_F(RegisteredBlock, asAnEnergyItComesToTheSameEquilibrium) {
  World with_row = [this] {
    add(makeTether);
    World world = sphere();
    world.run(3);
    unregisterConstraint("tether");
    return world;
  }();
  registerConstraint("tether", [](const Model& model) { return std::make_unique<TetherEnergy>(endOf(model)); });
  World with_energy = sphere();
  with_energy.run(3);
  EXPECT_LT((with_row.position(kParticle) - with_energy.position(kParticle)).norm(), 2e-6);
}

// Of the slow pull nearly all work is stored; the wall's viscosity and the scheme's damping, which are not in the
// account, take the rest.
TEST_F(RegisteredBlock, itsWorkIsInTheEnergyBalance) {
  add(makeTether);
  World world = sphere();
  const double before = energyBalance(*world.model, world.state);
  world.run(3);
  const double work = world.state.energy.pull_work;
  EXPECT_GT(work, 1e-5);
  const double change = energyBalance(*world.model, world.state) - before;
  EXPECT_NEAR(change, 0, 0.05 * work);
  // negative control: without the account of the tether the balance is off by its work
  EXPECT_GT(change + work, 0.9 * work);
}

TEST_F(RegisteredBlock, withoutRegistrationNothingHappens) {
  World plain = sphere();
  plain.run(1);
  EXPECT_LT(plain.maxShift(), 1e-6);
  EXPECT_EQ(plain.state.energy.pull_work, 0);
  EXPECT_EQ(constraintNames().back(), "gas");
}

TEST_F(RegisteredBlock, aSceneThatDoesNotNeedItHasNoBlock) {
  add([](const Model&) { return nullptr; });
  World world = sphere();
  EXPECT_EQ(constraintNames().back(), "tether");
  EXPECT_EQ(makeConstraintBlocks(*world.model).size(), 1u) << "of a sphere on a foundation: the pull spring";
  world.run(1);
  EXPECT_LT(world.maxShift(), 1e-6);
}

TEST_F(RegisteredBlock, aNameIsTakenOnce) {
  add([](const Model&) { return nullptr; });
  EXPECT_THROW(registerConstraint("tether", [](const Model&) { return nullptr; }), Error);
  EXPECT_THROW(registerConstraint("grip", [](const Model&) { return nullptr; }), Error);
  EXPECT_THROW(unregisterConstraint("grip"), Error);
  EXPECT_THROW(unregisterConstraint("leash"), Error);
}

TEST_F(RegisteredBlock, aSolverThatDividesTheStepUsesItsSubstepLoad) {
  add([](const Model& model) { return std::make_unique<TetherSubsteps>(endOf(model)); });
  World world = sphere("shape_matching");
  world.run(3);
  const Eigen::Vector3d hooke = kStiffness * (endOf(*world.model) - world.position(kParticle));
  EXPECT_GT(hooke.norm(), 0.02);
  EXPECT_LT((hooke + foundationForce(world)).norm(), 0.01 * hooke.norm());
}

TEST_F(RegisteredBlock, aSolverThatDividesTheStepRejectsABlockWithout) {
  EXPECT_NO_THROW(sphere("shape_matching"));
  add(makeTether);
  EXPECT_THROW(sphere("shape_matching"), Error);
}

}  // namespace
}  // namespace vibe::registered_block_test
