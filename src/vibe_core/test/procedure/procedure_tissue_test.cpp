// The procedure on tissue that moves: what the helix draws in the needle pierces, and the cinch draws bites together.
#include <gtest/gtest.h>

#include "procedure/procedure_bench.hpp"

namespace vibe::procedure_tissue_test {
namespace {

using Kind = Event::Kind;

constexpr double kRadius = 0.06;

/// A ball of shell with the scope entering at the top and looking down.
class ProcedureTissue : public ::testing::Test {
 protected:
  static Scene scene() {
    Scene scene;
    scene.foundation = FoundationScene{};
    scene.gas = GasScene{};
    scene.gas->initial_pressure = 800;
    scene.scope = test::scopeFromAbove(kRadius);
    scene.helix = HelixScene{};
    scene.suture = SutureScene{};
    return scene;
  }

  ProcedureTissue() : world(test::scopeWorld(scene(), test::openBall(kRadius, 3, 2.3e-3))) {}

  // Bends the tip, takes hold of the wall before it and screws the helix in.
  void takeHold(double bend) {
    input = {};
    input.joints[Insertion] = 0.095;
    input.joints[TipLeftRight] = bend;
    world.run(1, input);
    input.joints[HelixAdvance] = 0.0255;
    world.run(0.4, input);
    input.buttons[HelixGrab] = 1;
    input.joints[HelixRotation] = 6 * M_PI;
    world.run(1, input);
  }

  void pressNeedle() {
    input.buttons[Needle] = 1;
    world.step(input);
    input.buttons[Needle] = 0;
    world.step(input);
  }

  void moveArm(bool closed) {
    input.joints[NeedleDriver] = closed ? 0.018 : 0;
    world.run(0.25, input);
  }

  void drawIn(double advance) {
    input.joints[HelixAdvance] = advance;
    world.run(0.5, input);
  }

  void bite(double bend) {
    takeHold(bend);
    drawIn(0.003);
    moveArm(true);
    pressNeedle();
    moveArm(false);
    input.buttons[HelixGrab] = 0;
    world.run(0.5, input);
    moveArm(true);
    pressNeedle();
    moveArm(false);
  }

  Eigen::Vector3d place(int bite) const {
    return bitePosition(world.state.procedure.sutures.front().bites[bite], world.state.x, world.state.y, world.state.z);
  }

  test::World world;
  StepInput input;
};

TEST_F(ProcedureTissue, TheNeedleGoesDeeperTheMoreTheHelixDrawsIn) {
  takeHold(0);
  ASSERT_EQ(world.count(Kind::Grab), 1);
  ASSERT_EQ(world.count(Kind::HelixTurned), 1);
  std::vector<double> depths;
  for (const double advance : {0.018, 0.006, 0.0}) {
    drawIn(advance);
    world.events.clear();
    moveArm(true);
    ASSERT_EQ(world.count(Kind::Pierced) + world.count(Kind::BiteMissed), 1);
    const bool pierced = world.count(Kind::Pierced) == 1;
    for (const Event& event : world.events)
      if (event.kind == Kind::Pierced || event.kind == Kind::BiteMissed)
        depths.push_back(pierced ? event.value : -event.value);
    moveArm(false);
  }
  EXPECT_LT(depths[0], -2e-3) << "nothing drawn in, nothing pierced";
  EXPECT_GT(depths[1], 0) << "part of the wall";
  EXPECT_LT(depths[1], 2.3e-3);
  EXPECT_GT(depths[2], 2.3e-3) << "all of it";
}

TEST_F(ProcedureTissue, TheCinchDrawsTheBitesTogetherAndKeepsThem) {
  bite(-0.3);
  bite(0.3);
  ASSERT_EQ(world.count(Kind::Bite), 2);
  ASSERT_EQ(world.count(Kind::Rejected), 0);
  world.run(1, input);
  const double apart = (place(1) - place(0)).norm();
  ASSERT_GT(apart, 8e-3);
  input.buttons[TTag] = 1;
  world.step(input);
  input.buttons[TTag] = 0;
  input.buttons[Cinch] = 1;
  world.run(apart / 15e-3 + 1, input);
  EXPECT_EQ(world.count(Kind::CinchPulling), 1);
  input.buttons[Cinch] = 0;
  world.run(1, input);
  ASSERT_EQ(world.count(Kind::Cinched), 1);
  const Suture& suture = world.state.procedure.sutures.front();
  const double together = (place(1) - place(0)).norm();
  EXPECT_GT(suture.cinch_tension, 0.5);
  EXPECT_LT(together, 0.5 * apart);
  EXPECT_LT(together, 1.05 * suture.length.front() + 0.5e-3) << "no farther apart than the thread is long";
  EXPECT_TRUE(world.state.procedure.needle_loaded);
  EXPECT_EQ(world.count(Kind::Recovery), 0);
}

}  // namespace
}  // namespace vibe::procedure_tissue_test
