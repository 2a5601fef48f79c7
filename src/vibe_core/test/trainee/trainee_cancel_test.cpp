// Goals that are given up on request, while others go on.
#include <gtest/gtest.h>

#include "vibe_core/files/files.hpp"
#include "vibe_core/simulation/simulation.hpp"
#include "vibe_core/trainee/trainee.hpp"

namespace vibe::trainee_cancel_test {
namespace {

std::shared_ptr<const Model> coarseStomach() {
  static const std::shared_ptr<const Model> model = [] {
    Scene scene;
    scene.seed = 3;
    scene.geometry.particles = 800;
    scene.attach_oesophagus = scene.attach_duodenum = true;
    scene.gas.emplace().initial_pressure = 667;
    scene.gas->insufflator_on = false;
    scene.foundation.emplace().stiffness = 5e3;
    scene.scope.emplace();
    scene.helix.emplace().reach = 8e-3;  // the particles are 9 mm apart
    scene.suture.emplace();
    return buildModel(scene, readTextFile(std::string(VIBE_DESCRIPTION_DIR) + "/urdf/scope.urdf", "URDF"));
  }();
  return model;
}

struct Session {
  Session() : simulation(coarseStomach()), trainee(simulation.sharedModel(), still(), 1) {}

  static Skill still() {
    Skill skill;
    skill.tremor.scale = 0;
    return skill;
  }
  void steps(int count) {
    for (int k = 0; k < count && !trainee.done(); ++k) simulation.step(trainee.next(observe(simulation)));
  }
  double time() const { return simulation.time(); }

  Simulation simulation;
  Trainee trainee;
};

TEST(TraineeCancel, TheActiveGoalEndsAndTheNextBegins) {
  Session session;
  EXPECT_EQ(session.trainee.add(WaitGoal{100}), 0);
  EXPECT_EQ(session.trainee.add(WaitGoal{0.5}), 1);
  session.steps(30);
  EXPECT_EQ(session.trainee.current(), 0);
  session.trainee.cancel(0);
  session.trainee.cancel(0);  // twice is as good as once
  session.steps(600);
  ASSERT_TRUE(session.trainee.done());
  EXPECT_LT(session.time(), 5);
  EXPECT_FALSE(session.trainee.results()[0].reached);
  EXPECT_EQ(session.trainee.results()[0].reason, "cancelled");
  EXPECT_TRUE(session.trainee.results()[1].reached) << session.trainee.results()[1].reason;
}

TEST(TraineeCancel, AWaitingGoalIsLeftOut) {
  Session session;
  session.trainee.add(WaitGoal{0.5});
  session.trainee.add(WaitGoal{100});
  session.trainee.add(WaitGoal{0.5});
  session.trainee.cancel(1);
  session.steps(600);
  ASSERT_TRUE(session.trainee.done());
  EXPECT_TRUE(session.trainee.results()[0].reached);
  EXPECT_EQ(session.trainee.results()[1].reason, "cancelled");
  EXPECT_TRUE(session.trainee.results()[2].reached);
}

TEST(TraineeCancel, WhileItHoldsTissueItLetsGoAndDrawsBack) {
  Session session;
  session.trainee.add(InsufflateGoal{1});
  const int bite = session.trainee.add(BiteGoal{{0.5, 0.35, 0, 0}});
  for (int k = 0; k < 900 && session.simulation.state().grip.empty(); ++k) session.steps(1);
  ASSERT_FALSE(session.simulation.state().grip.empty()) << "nothing is held";
  ASSERT_EQ(session.trainee.current(), bite);
  session.trainee.cancel(bite);
  session.steps(400);
  ASSERT_TRUE(session.trainee.done());
  EXPECT_EQ(session.trainee.results()[bite].reason, "cancelled");
  for (int k = 0; k < 30; ++k) session.simulation.step(session.trainee.next(observe(session.simulation)));
  EXPECT_TRUE(session.simulation.state().grip.empty());
  EXPECT_EQ(session.simulation.input().buttons[HelixGrab], 0);
  EXPECT_EQ(session.simulation.input().buttons[Insufflate], 1) << "gas stays in the lumen";
  EXPECT_LE(session.simulation.state().joints[Insertion], 0.051);
}

TEST(TraineeCancel, WhatHasEndedStaysAsItIs) {
  Session session;
  session.trainee.add(WaitGoal{0.1});
  session.steps(60);
  session.trainee.cancel(0);
  session.trainee.add(WaitGoal{0.1});
  session.steps(60);
  EXPECT_TRUE(session.trainee.results()[0].reached);
  EXPECT_TRUE(session.trainee.results()[1].reached);
}

}  // namespace
}  // namespace vibe::trainee_cancel_test
