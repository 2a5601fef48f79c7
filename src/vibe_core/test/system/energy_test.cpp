// The energy account of sessions on the default stomach: what is put in is stored or lost, term by term.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/model/accounting.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/simulation/simulation.hpp"
#include "vibe_core/trainee/trainee_script.hpp"
#include "vibe_testing/scope_fixture.hpp"

namespace vibe::energy_test {
namespace {

constexpr double kBound = 0.01;  // of the work put in

Scene stomachScene(bool rigid_scope = true) {
  Scene scene = loadScene(std::string(VIBE_CORE_DIR) + "/scenes/stomach.yaml");
  scene.geometry.particles = 1500;
  scene.render_surface = false;
  if (rigid_scope) scene.scope->compliance.reset();  // it does more work on the wall
  return scene;
}

/// A session that sums up what is put in, step by step: what comes back later does not count against it.
struct Session {
  Simulation simulation;
  double start, put_in = 0;

  explicit Session(const Scene& scene)
      : simulation(buildModel(scene, scene.scope ? scopeText() : ""), SimulationSettings::study(1)),
        start(energyBalance(simulation.model(), simulation.state())) {}

  static std::array<double, 4> works(const EnergyAccount& e) {
    return {e.tool_work, e.gas_work, e.thread_work, e.pull_work};
  }
  template <class Input>
  void run(double seconds, Input input) {
    const std::int64_t steps = std::lround(seconds / simulation.stepPeriod());
    for (std::int64_t i = 0; i < steps; ++i) {
      const std::array<double, 4> before = works(simulation.state().energy);
      simulation.step(input(simulation.state()));
      const std::array<double, 4> after = works(simulation.state().energy);
      for (std::size_t k = 0; k < 4; ++k) put_in += std::max(0.0, after[k] - before[k]);
    }
  }
  double balance() const { return energyBalance(simulation.model(), simulation.state()) - start; }
  const EnergyAccount& account() const { return simulation.state().energy; }
};

void expectClosed(const Session& session) {
  ::testing::Test::RecordProperty("put_in_J", std::to_string(session.put_in));
  ::testing::Test::RecordProperty("balance_J", std::to_string(session.balance()));
  ::testing::Test::RecordProperty("residual_J", std::to_string(session.account().residual_work));
  EXPECT_LT(std::abs(session.balance()), kBound * session.put_in);
}

TEST(Energy, AccountOfGrabsIsClosed) {
  Session session(stomachScene());
  const TraineeScript script = TraineeScript::load(std::string(VIBE_CORE_DIR) + "/trainees/demo/grabs.yaml");
  session.run(60, [&](const State& state) { return script.at(state.time); });
  ASSERT_GT(session.put_in, 0.1);
  ASSERT_GT(session.account().tool_work, 0.01);
  expectClosed(session);
  EXPECT_LT(std::abs(session.account().residual_work), kBound * session.put_in);
  // each of these alone would open it
  for (const double term : {session.account().tool_work, session.account().gas_work, session.account().damping_loss,
                            session.account().numerical_loss})
    EXPECT_GT(std::abs(term), kBound * session.put_in);
}

// The scope presses into the wall and withdraws.
void pressAndWithdraw(bool rigid, double least_work) {
  Session session(stomachScene(rigid));
  const auto insert = [](double length, bool insufflate) {
    StepInput input;
    input.buttons[Insufflate] = insufflate ? 1 : 0;
    input.joints[Insertion] = length;
    input.joints[TipUpDown] = 0.4 * std::min(1.0, std::max(0.0, length - 0.05) / 0.05);  // straight in the entry
    return input;
  };
  session.run(8, [&](const State& state) { return insert(std::min(0.12, 0.02 * state.time), true); });
  const double before = session.account().tool_work;
  session.run(3, [&](const State& state) { return insert(std::min(0.18, 0.12 + 0.05 * (state.time - 8)), false); });
  ASSERT_GT(session.account().tool_work, before + least_work);
  ASSERT_GT(session.simulation.state().contact_count, 0);
  session.run(4, [&](const State& state) { return insert(std::max(0.05, 0.18 - 0.05 * (state.time - 11)), false); });
  EXPECT_EQ(session.simulation.state().contact_count, 0);
  expectClosed(session);
}
// The first evaluation of a step settles what the step before has foreseen wrong; a recovery has none.
TEST(Energy, ARecoverySettlesWhatTheStepBeforeHasForeseenWrong) {
  constexpr double kWrong = 0.05;  // [J]
  Session session(stomachScene());
  session.run(0.1, [](const State& state) {
    StepInput still;
    still.joints = state.joints;
    return still;
  });
  State state = session.simulation.state();
  state.solver.elastic_energy += kWrong;
  state.energy.numerical_loss -= kWrong;
  state.solver.recovery_steps = 1;
  const double settled = session.balance();
  session.simulation.replaceState(std::move(state));
  StepInput still;
  still.joints = session.simulation.state().joints;
  session.simulation.step(still);
  EXPECT_NEAR(session.balance(), settled, 1e-3 * kWrong);
}

TEST(Energy, AccountOfAPressedScopeIsClosed) {
  pressAndWithdraw(true, 0.02);
}
TEST(Energy, AccountOfAPressedScopeThatGivesWayIsClosed) {
  pressAndWithdraw(false, 0.005);
}

TEST(Energy, AccountOfChangesOfPressureIsClosed) {
  Scene scene = stomachScene();
  scene.scope.reset(), scene.helix.reset(), scene.suture.reset();
  scene.gas->flow_limit = 2e-3;
  scene.gas->regulated_pressure = 45 * 133.322;
  Session session(scene);
  session.run(5, [](const State& state) {
    StepInput input;
    input.buttons[Insufflate] = std::fmod(state.time, 2) < 1 ? 1 : 0;
    if (input.buttons[Insufflate] == 0) {
      input.pull_particle = 100;
      input.pull_target.setZero();
    }
    return input;
  });
  ASSERT_GT(session.put_in, 1);
  expectClosed(session);
  EXPECT_LT(std::abs(session.account().residual_work), kBound * session.put_in);
}

}  // namespace
}  // namespace vibe::energy_test
