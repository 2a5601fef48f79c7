// The procedure as a whole: its way through a session, what is refused, and what no order of commands can spoil.
#include "procedure/procedure.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "procedure/procedure_bench.hpp"
#include "vibe_core/arithmetic/random.hpp"
#include "vibe_core/suture/technique.hpp"
#include "vibe_testing/allocation_count.hpp"

namespace vibe::procedure_test {
namespace {

using test::Bench;
using test::benchScene;
using test::finishOneSet;
using test::kBenchRadius;
using Kind = Event::Kind;

/// Integers that are the same everywhere (Steele, Lea & Flood 2014).
struct Dice {
  std::uint64_t state;
  int below(int n) { return static_cast<int>(nextInteger(state) % static_cast<std::uint64_t>(n)); }
};

void expectSoundBite(const Bite& bite) {
  ASSERT_EQ(bite.particle.size(), bite.weight.size());
  ASSERT_FALSE(bite.particle.empty());
  double sum = 0;
  for (double weight : bite.weight) sum += weight;
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_TRUE(std::isfinite(bite.depth) && bite.depth > 0 && bite.depth <= 10e-3);
  EXPECT_TRUE(std::isfinite(bite.time) && std::isfinite(bite.along) && bite.thickness > 0);
}

void expectSound(const Bench& bench) {
  const ProcedureState& p = bench.world.state.procedure;
  ASSERT_LE(p.sutures.size(), 64u);
  bool waits_for_cinch = false;
  for (std::size_t k = 0; k < p.sutures.size(); ++k) {
    const Suture& suture = p.sutures[k];
    ASSERT_FALSE(suture.bites.empty());
    ASSERT_EQ(suture.length.size(), suture.bites.size() - 1);
    ASSERT_EQ(suture.tension.size(), suture.length.size());
    for (const Bite& bite : suture.bites) expectSoundBite(bite);
    for (double length : suture.length) EXPECT_TRUE(std::isfinite(length) && length > 0);
    const bool last = k + 1 == p.sutures.size();
    EXPECT_TRUE(last || suture.permanent()) << "only the last may be unfinished";
    waits_for_cinch |= suture.stage == Suture::Stage::Tagged || suture.stage == Suture::Stage::Cinching;
  }
  EXPECT_EQ(p.needle_loaded, !waits_for_cinch) << "no needle, and nothing that would bring a new one";
  EXPECT_TRUE(!p.pierced || p.arm_closed);
  EXPECT_TRUE(std::isfinite(p.thread_used) && std::isfinite(p.blood_lost));
}

TEST(Procedure, GoesFromTheFirstBiteToACinchedSet) {
  Bench bench;
  bench.state().joints[Insertion] = 0.1;
  const std::vector<int> sites = {3, 40, 77, 120};
  for (int k = 0; k < 4; ++k) {
    bench.goTo(sites[k]);
    bench.closeArm();
    EXPECT_EQ(bench.count(Kind::Pierced), 1);
    bench.press(Needle);
    ASSERT_EQ(bench.count(Kind::Bite), 1);
    EXPECT_FALSE(bench.procedure().needle_on_arm);
    bench.press(Needle);
    EXPECT_EQ(bench.count(Kind::Rejected), 1) << "the arm is still in the bite";
    bench.openArm();
    bench.closeInAir();
    bench.press(Needle);
    EXPECT_EQ(bench.count(Kind::NeedleExchanged), 1);
    bench.openArm();
  }
  Suture& suture = bench.procedure().sutures.front();
  ASSERT_EQ(suture.bites.size(), 4u);
  double used = 0;
  for (int k = 0; k < 3; ++k) {
    const double distance = (bench.world.position(sites[k + 1]) - bench.world.position(sites[k])).norm();
    EXPECT_NEAR(suture.length[k], distance, 0.2 * distance) << "bites lie around their vertices";
    used += suture.length[k];
  }
  EXPECT_NEAR(bench.procedure().thread_used, used, 1e-12);
  bench.press(TTag);
  EXPECT_EQ(bench.count(Kind::TTagDropped), 1);
  EXPECT_EQ(bench.count(Kind::TechniqueFound), 1);
  EXPECT_EQ(suture.taken.size(), 4u);
  const auto by = [&suture](TechniqueRule rule) {
    return static_cast<int>(recogniseTechnique(suture.taken, rule).technique);
  };
  EXPECT_EQ(suture.corrected_technique, by(TechniqueRule::Corrected));
  EXPECT_EQ(suture.printed_technique, by(TechniqueRule::Printed));
  EXPECT_EQ(suture.stage, Suture::Stage::Tagged);
  EXPECT_EQ(bench.procedure().phase, Phase::Pull);
  const double whole = suture.length.front();
  bench.hold(Cinch);
  EXPECT_TRUE(suture.pulls());
  for (int k = 0; k < 29; ++k) bench.act();
  const double drawn = 30 * bench.model().scene.suture->cinch_speed * bench.model().scene.step_period;
  EXPECT_NEAR(suture.pulled, drawn, 1e-12);
  EXPECT_NEAR(suture.length.front(), whole - drawn, 1e-12);
  suture.tension = {2.5, 2, 1};
  bench.hold(Cinch, false);
  ASSERT_EQ(bench.count(Kind::Cinched), 1);
  EXPECT_EQ(suture.stage, Suture::Stage::Cinched);
  EXPECT_EQ(suture.cinch_tension, 2.5);
  EXPECT_TRUE(bench.procedure().needle_loaded && bench.procedure().needle_on_arm);
  EXPECT_EQ(bench.procedure().thread_used, 0);
  EXPECT_EQ(bench.procedure().phase, Phase::Suture);
}

TEST(Procedure, TheCinchStopsDrawingAtItsTension) {
  Bench bench;
  bench.bite(3);
  bench.bite(40);
  bench.press(TTag);
  bench.hold(Cinch);
  Suture& suture = bench.procedure().sutures.front();
  suture.tension.front() = bench.model().scene.suture->cinch_tension;
  const double length = suture.length.front();
  bench.act();
  EXPECT_EQ(suture.length.front(), length);
  suture.tension.front() *= 0.99;
  bench.act();
  EXPECT_LT(suture.length.front(), length);
}

TEST(Procedure, ALooseCinchIsSaidSo) {
  Bench bench;
  bench.bite(3);
  bench.bite(40);
  bench.press(TTag);
  bench.hold(Cinch);
  bench.procedure().sutures.front().tension.front() = 0.49;
  bench.hold(Cinch, false);
  EXPECT_EQ(bench.count(Kind::CinchLoose), 1);
  EXPECT_EQ(bench.count(Kind::Cinched), 0);
  EXPECT_TRUE(bench.procedure().sutures.front().permanent());
}

TEST(Procedure, CinchingStopsTheBleedingsOfItsSetUnlessItIsLoose) {
  for (const bool loose : {false, true}) {
    Scene scene = benchScene();
    scene.bleeding = BleedingScene{};
    scene.bleeding->brisk_probability = 1;
    Bench bench(scene);
    bench.bite(3);
    bench.bite(40);
    ASSERT_EQ(bench.procedure().bleedings.size(), 2u);
    bench.press(TTag);
    bench.hold(Cinch);
    bench.procedure().sutures.front().tension.front() = loose ? 0.1 : 2;
    bench.hold(Cinch, false);
    EXPECT_EQ(bench.count(Kind::BleedingStopped), loose ? 0 : 2);
    const double lost = bench.procedure().blood_lost;
    EXPECT_GT(lost, 0);
    bench.act();
    EXPECT_EQ(bench.procedure().blood_lost > lost, loose);
  }
}

TEST(Procedure, PhasesFollowWhatIsDone) {
  Bench bench;
  bench.state().joints[Insertion] = 0.1;
  bench.act();
  EXPECT_EQ(bench.procedure().phase, Phase::Inspect);
  bench.closeArm();
  EXPECT_EQ(bench.procedure().phase, Phase::Suture);
  bench.openArm();
  finishOneSet(bench);
  EXPECT_EQ(bench.procedure().phase, Phase::Suture);
  bench.state().joints[Insertion] = 0.015;
  bench.act();
  EXPECT_EQ(bench.procedure().phase, Phase::Suture) << "not out yet";
  bench.state().joints[Insertion] = 0.005;
  bench.act();
  EXPECT_EQ(bench.procedure().phase, Phase::Done);
  bench.state().joints[Insertion] = 0.015;
  bench.act();
  EXPECT_EQ(bench.procedure().phase, Phase::Done);
  bench.state().joints[Insertion] = 0.1;
  bench.act();
  EXPECT_EQ(bench.procedure().phase, Phase::Inspect);
  finishOneSet(bench);
  EXPECT_EQ(bench.procedure().sutures.size(), 2u) << "Done forbids nothing";
}

TEST(Procedure, AnUnfinishedSetIsNotDone) {
  Bench bench;
  finishOneSet(bench);
  bench.state().joints[Insertion] = 0.1;
  bench.bite(5);
  bench.state().joints[Insertion] = 0;
  bench.act();
  EXPECT_EQ(bench.procedure().phase, Phase::Suture);
}

TEST(Procedure, ThreadThatIsUsedUpLeavesAWayOut) {
  Scene scene = benchScene();
  scene.suture->thread_length = 0.5 * kBenchRadius;
  Bench bench(scene);
  bench.bite(3);
  int far = 0;  // the vertex opposite
  for (int v = 0; v < bench.model().particle_count; ++v)
    if ((bench.world.position(v) + bench.world.position(3)).norm() < 1e-3) far = v;
  bench.goTo(far);
  bench.closeArm();
  bench.press(Needle);
  EXPECT_NE(bench.refusal().find("thread is used up"), std::string::npos) << bench.refusal();
  EXPECT_EQ(bench.procedure().sutures.front().bites.size(), 1u);
  EXPECT_TRUE(bench.procedure().pierced);
  bench.openArm();
  EXPECT_EQ(bench.count(Kind::BiteWithdrawn), 1);
  bench.bite(3);  // near enough
  bench.press(TTag);
  bench.press(Cinch);
  EXPECT_TRUE(bench.procedure().sutures.front().permanent());
  expectSound(bench);
}

TEST(Procedure, HoldsSixtyFourSetsAndRefusesTheNextOne) {
  Bench bench;
  for (int set = 0; set < 64; ++set) finishOneSet(bench);
  ASSERT_EQ(bench.procedure().sutures.size(), 64u);
  bench.closeArm();
  bench.press(Needle);
  EXPECT_NE(bench.refusal().find("64 sets"), std::string::npos);
  bench.openArm();
  expectSound(bench);
  EXPECT_EQ(bench.procedure().sutures.size(), 64u);
}

TEST(Procedure, EverythingPressedAtOnceIsTakenInOrder) {
  Bench bench;
  bench.bite(3);
  bench.bite(40);
  bench.input.buttons.fill(1);
  bench.act();  // the needle is on an open arm: its button is refused, the T-tag drops, the cinch begins
  EXPECT_EQ(bench.count(Kind::TTagDropped), 1);
  EXPECT_EQ(bench.count(Kind::CinchPulling), 1);
  std::set<int> refused;
  for (const Event& event : bench.events)
    if (event.kind == Kind::Rejected) refused.insert(static_cast<int>(event.value));
  EXPECT_EQ(refused, (std::set<int>{ApcPedal, Needle, Insufflate}));
  expectSound(bench);
  bench.act();
  EXPECT_EQ(bench.count(Kind::Rejected), 0) << "a held button asks once";
}

TEST(Procedure, AThousandBitesInASecond) {
  Scene scene = benchScene();
  scene.step_period = 1e-4;
  scene.suture->thread_length = 1e9;
  Bench bench(scene);
  for (int k = 0; k < 1000; ++k) {
    bench.bite(k % bench.model().particle_count);
    expectSound(bench);
  }
  EXPECT_LT(bench.state().time, 1.0);
  EXPECT_EQ(static_cast<int>(bench.procedure().sutures.front().bites.size()), scene.suture->max_bites);
  finishOneSet(bench);
  EXPECT_TRUE(bench.procedure().sutures.front().permanent());
}

// Any command in any order, the ones that lead on more often than others.
void randomCommand(Bench& bench, Dice& dice) {
  const std::array<Button, 12> buttons = {Needle, Needle, Needle, Needle, TTag,       TTag,
                                          Cinch,  Cinch,  Cinch,  Cinch,  Insufflate, ApcPedal};
  bench.beyond = dice.below(5) == 0 ? -5e-3 : 1e-3 * dice.below(4);
  bench.goTo(dice.below(bench.model().particle_count));
  const int what = dice.below(12);
  if (what < 4)
    bench.moveArm(0.5 * dice.below(3));
  else if (what < 10)
    bench.hold(buttons[dice.below(12)], dice.below(2) == 1);
  else if (what == 10 && !bench.procedure().sutures.empty())
    for (double& tension : bench.procedure().sutures.back().tension) tension = dice.below(30) == 0 ? 20 : dice.below(5);
  else
    bench.act();
}

Scene hardScene(std::uint64_t seed) {
  Scene scene = benchScene();
  scene.seed = seed;
  scene.suture->max_bites = 5;
  scene.suture->thread_length = 0.15;
  scene.bleeding = BleedingScene{};
  scene.bleeding->mild_probability = 0.5;
  return scene;
}

// An event whose detail or reason is missing would show as its name, or as a rejection without a remedy.
void expectDescribed(const std::vector<Event>& events) {
  for (const Event& event : events) {
    EXPECT_NE(describe(event), std::string(toString(event.kind)) + ".");
    EXPECT_EQ(event.kind == Kind::Rejected, event.reason != RejectReason::None) << toString(event.kind);
  }
}

TEST(Procedure, NoOrderOfCommandsSpoilsTheStateOrClosesTheWayToASet) {
  int bites = 0, cinched = 0, broken = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Bench bench(hardScene(seed), 1);
    Dice dice{seed};
    for (int k = 0; k < 1000; ++k) {
      randomCommand(bench, dice);
      expectSound(bench);
      expectDescribed(bench.events);
      if (::testing::Test::HasFailure()) FAIL() << "seed " << seed << ", command " << k;
    }
    const std::size_t sets = bench.procedure().sutures.size();
    bench.beyond = 2e-3;
    for (Suture& suture : bench.procedure().sutures) std::fill(suture.tension.begin(), suture.tension.end(), 0.0);
    finishOneSet(bench);
    EXPECT_GE(bench.procedure().sutures.size(), std::max<std::size_t>(sets, 1));
    EXPECT_EQ(bench.procedure().sutures.back().stage, Suture::Stage::Cinched);
    for (const Suture& suture : bench.procedure().sutures) {
      bites += static_cast<int>(suture.bites.size());
      cinched += suture.stage == Suture::Stage::Cinched ? 1 : 0;
      broken += suture.stage == Suture::Stage::Broken ? 1 : 0;
    }
  }
  EXPECT_GT(bites, 50) << "or the commands did nothing";
  EXPECT_GT(cinched, 10);
  EXPECT_GT(broken, 0);
}

TEST(Procedure, TheSameCommandsDoTheSame) {
  const auto run = [](std::uint64_t seed) {
    Bench bench(hardScene(seed), 1);
    Dice dice{99};
    for (int k = 0; k < 1500; ++k) randomCommand(bench, dice);
    std::string told;
    for (const Event& event : bench.world.events) told += describe(event) + "\n";
    return told;
  };
  EXPECT_TRUE(run(1) == run(1));
  EXPECT_FALSE(run(1) == run(2)) << "other bleedings";
}

TEST(Procedure, StepsWithoutCommandsAskForNoMemory) {
#if VIBE_COUNTS_ALLOCATIONS
  Scene scene = benchScene();
  scene.bleeding = BleedingScene{};
  scene.bleeding->brisk_probability = 1;
  Bench bench(scene);
  bench.state().joints[Insertion] = 0.1;
  finishOneSet(bench);
  bench.procedure().sutures.front().tension.front() = 2;
  const auto poses = bench.poses();
  const auto allocationsIn = [&](int steps) {
    const long before = test::allocations;
    for (int k = 0; k < steps; ++k) {
      commandProcedure(bench.model(), poses, bench.input, bench.state(), {bench.state(), bench.events});
      updateProcedure(bench.model(), bench.state(), {bench.state(), bench.events});
    }
    return test::allocations - before;
  };
  EXPECT_EQ(allocationsIn(100), 0) << "a set and its bleedings";
  bench.bite(3);
  bench.bite(40);
  EXPECT_EQ(allocationsIn(100), 0) << "an open set";
  bench.press(TTag);
  bench.hold(Cinch);
  EXPECT_EQ(allocationsIn(100), 0) << "a set being cinched";
  ASSERT_EQ(bench.procedure().sutures.back().stage, Suture::Stage::Cinching);
#endif
}

TEST(Procedure, TheWholeSimulatorBearsCommandsThatAreNoNumbers) {
  Scene scene = hardScene(4);
  scene.tissue.mass_damping = 30;
  test::World world(scene, test::plainOrgan(test::icosphere(kBenchRadius, 1), 2e-3), scopeText());
  Dice dice{5};
  for (int k = 0; k < 600; ++k) {
    StepInput input;
    for (int j = 0; j < kJointCount; ++j) {
      input.joints[j] = 0.01 * dice.below(10);
      if (dice.below(5) == 0) input.joints[j] = std::numeric_limits<double>::quiet_NaN();
      if (dice.below(9) == 0) input.joints[j] = 1e300;
    }
    for (auto& button : input.buttons) button = static_cast<std::uint8_t>(dice.below(2));
    world.step(input);
    for (int i = 0; i < world.model->particle_count; ++i) ASSERT_TRUE(world.position(i).allFinite());
    for (double joint : world.state.joints) ASSERT_TRUE(std::isfinite(joint));
  }
  EXPECT_GT(world.count(Kind::Rejected), 10);
  EXPECT_EQ(world.count(Kind::Recovery), 0);
}

}  // namespace
}  // namespace vibe::procedure_test
