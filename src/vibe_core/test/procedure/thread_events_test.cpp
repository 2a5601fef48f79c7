#include "procedure/suturing.hpp"

#include <gtest/gtest.h>

#include "procedure/procedure_bench.hpp"

namespace vibe::thread_events_test {
namespace {

using Kind = Event::Kind;

/// A thread through places in space: every bite holds one particle.
struct Thread {
  Model model;
  State state;
  std::vector<Event> events;

  explicit Thread(const std::vector<Eigen::Vector3d>& places, Suture::Stage stage = Suture::Stage::Cinched) {
    model.scene.suture = SutureScene{};
    Suture& suture = state.procedure.sutures.emplace_back();
    suture.stage = stage;
    for (const Eigen::Vector3d& p : places) {
      state.x.push_back(p.x());
      state.y.push_back(p.y());
      state.z.push_back(p.z());
      Bite bite;
      bite.particle = {static_cast<int>(state.x.size()) - 1};
      bite.weight = {1};
      bite.depth = bite.thickness = 2e-3;
      suture.bites.push_back(bite);
    }
    suture.length.assign(places.size() - 1, 0.01);
    suture.tension.assign(places.size() - 1, 0);
    state.procedure.needle_loaded = state.procedure.needle_on_arm = suture.permanent();
  }
  Suture& suture() { return state.procedure.sutures.front(); }
  void update() {
    events.clear();
    updateThreads(model, state, {state, events});
  }
  int count(Kind kind) const {
    int n = 0;
    for (const Event& event : events) n += event.kind == kind ? 1 : 0;
    return n;
  }
};

const std::vector<Eigen::Vector3d> kCorner = {{0, 0, 0}, {0.01, 0, 0}, {0.01, 0.02, 0}, {0.01, 0.05, 0}};

TEST(ThreadEvents, ForceOnABiteIsTheSumOfTheSegmentsPulls) {
  Thread thread(kCorner);
  thread.suture().tension = {3, 4, 4};
  EXPECT_LT((forceOnBite(thread.suture(), 0, thread.state) - Eigen::Vector3d(3, 0, 0)).norm(), 1e-12);
  EXPECT_LT((forceOnBite(thread.suture(), 1, thread.state) - Eigen::Vector3d(-3, 4, 0)).norm(), 1e-12);
  EXPECT_LT(forceOnBite(thread.suture(), 2, thread.state).norm(), 1e-12) << "straight through";
  EXPECT_LT((forceOnBite(thread.suture(), 3, thread.state) - Eigen::Vector3d(0, -4, 0)).norm(), 1e-12);
}

TEST(ThreadEvents, HoldsLessInPartOfTheWall) {
  const SutureScene scene;
  Bite bite;
  bite.thickness = 2e-3;
  for (const auto& [depth, part] : {std::pair{4e-3, 1.0}, {2e-3, 1.0}, {1e-3, 0.5}, {0.1e-3, 0.25}}) {
    bite.depth = depth;
    EXPECT_NEAR(holdOfBite(scene, bite), part * scene.pull_out_force, 1e-12);
  }
}

TEST(ThreadEvents, AMiddleBiteTearsOutAndItsSegmentsBecomeOne) {
  Thread thread(kCorner);
  thread.suture().length = {0.010, 0.020, 0.030};
  thread.suture().tension = {6, 6, 1};  // 8.5 N at the corner, which holds 8
  thread.update();
  ASSERT_EQ(thread.count(Kind::TearOut), 1);
  EXPECT_NEAR(thread.events.front().value, 6 * std::sqrt(2.0), 1e-12);
  EXPECT_EQ(thread.events.front().particle, 1);
  ASSERT_EQ(thread.suture().bites.size(), 3u);
  EXPECT_EQ(thread.suture().length, (std::vector<double>{0.030, 0.030}));
  EXPECT_EQ(thread.suture().tension, (std::vector<double>{6, 1}));
  EXPECT_EQ(thread.suture().tear_outs, 1);
  EXPECT_EQ(thread.suture().stage, Suture::Stage::Cinched);
}

TEST(ThreadEvents, JustBelowItsHoldNothingTears) {
  Thread thread(kCorner);
  thread.suture().tension = {5.6, 5.6, 5.6};  // 7.92 N at the corner
  thread.update();
  EXPECT_TRUE(thread.events.empty());
}

TEST(ThreadEvents, EndBitesTakeTheirSegmentWithThem) {
  for (const bool first : {true, false}) {
    Thread thread(kCorner);
    thread.suture().length = {0.010, 0.020, 0.030};
    thread.suture().bites[first ? 0 : 3].depth = 0;  // holds 2 N
    thread.suture().tension = {3, 3, 3};
    thread.update();
    ASSERT_EQ(thread.count(Kind::TearOut), 1);
    const std::vector<double> left = first ? std::vector<double>{0.020, 0.030} : std::vector<double>{0.010, 0.020};
    EXPECT_EQ(thread.suture().length, left);
    EXPECT_EQ(thread.suture().tension.size(), 2u);
  }
}

TEST(ThreadEvents, OneBitePerStepAndTheWorstFirst) {
  Thread thread({{0, 0, 0}, {0.02, 0, 0}, {0.02, 0.02, 0}, {0, 0.02, 0}});
  thread.suture().tension = {7, 7, 7};  // 9.9 N at both corners
  thread.suture().bites[2].depth = 1e-3;
  thread.update();
  EXPECT_EQ(thread.count(Kind::TearOut), 1);
  EXPECT_EQ(thread.events.front().particle, 2);
  EXPECT_EQ(thread.suture().bites.size(), 3u);
}

TEST(ThreadEvents, BelowTwoBitesTheSetIsBroken) {
  Thread thread({{0, 0, 0}, {0.02, 0, 0}});
  thread.suture().tension = {9};
  thread.update();
  EXPECT_EQ(thread.suture().stage, Suture::Stage::Broken);
  EXPECT_TRUE(thread.suture().length.empty() && thread.suture().tension.empty());
  EXPECT_FALSE(thread.suture().pulls());
  thread.update();
  EXPECT_TRUE(thread.events.empty());
}

TEST(ThreadEvents, BreaksAboveItsStrengthAndTheDeviceTakesANewThread) {
  for (const Suture::Stage stage : {Suture::Stage::Cinching, Suture::Stage::Cinched}) {
    Thread thread(kCorner, stage);
    thread.suture().tension = {14.2, 14.2, 14.2};
    thread.state.procedure.thread_used = 0.4;
    thread.update();
    EXPECT_EQ(thread.count(Kind::ThreadBroke), 1);
    EXPECT_EQ(thread.count(Kind::TearOut), 0) << "a broken thread pulls nothing out";
    EXPECT_EQ(thread.suture().stage, Suture::Stage::Broken);
    EXPECT_EQ(thread.suture().tension, std::vector<double>(3, 0.0));
    EXPECT_TRUE(thread.state.procedure.needle_loaded && thread.state.procedure.needle_on_arm);
    EXPECT_EQ(thread.state.procedure.thread_used, stage == Suture::Stage::Cinching ? 0 : 0.4);
  }
}

TEST(ThreadEvents, AnOldSetThatBreaksLeavesTheNeedleWhereItIs) {
  Thread thread(kCorner);
  thread.state.procedure.needle_on_arm = false;
  thread.suture().tension = {20, 20, 20};
  thread.update();
  EXPECT_EQ(thread.count(Kind::ThreadBroke), 1);
  EXPECT_FALSE(thread.state.procedure.needle_on_arm);
}

TEST(ThreadEvents, TensionThatIsNoNumberIsNone) {
  Thread thread(kCorner);
  thread.suture().tension = {std::nan(""), INFINITY, 1};
  thread.update();
  EXPECT_TRUE(thread.events.empty());
  EXPECT_EQ(thread.suture().tension, (std::vector<double>{0, 0, 1}));
}

TEST(ThreadEvents, FreeThreadFollowsTheTissueAndAPulledOneDoesNot) {
  for (const Suture::Stage stage : {Suture::Stage::Open, Suture::Stage::Tagged, Suture::Stage::Cinching}) {
    Thread thread(kCorner, stage);
    thread.suture().length = {0.001, 0.5, 0.001};
    thread.update();
    const bool runs_free = stage != Suture::Stage::Cinching;
    EXPECT_NEAR(thread.suture().length[0], runs_free ? 0.01 : 0.001, 1e-12);
    EXPECT_NEAR(thread.suture().length[1], 0.5, 1e-12) << "it does not run back";
    const bool counts = stage == Suture::Stage::Open;
    EXPECT_NEAR(thread.state.procedure.thread_used, counts ? 0.01 + 0.5 + 0.03 : 0, 1e-12);
  }
}

TEST(ThreadEvents, TheCinchDrawsFromItsSegmentThenFromTheNextAndStopsAtTheFloor) {
  Thread thread(kCorner);
  thread.suture().length = {kMinSegment + 0.0015, kMinSegment + 0.002, kMinSegment + 0.001};
  EXPECT_NEAR(drawThread(0.001, thread.suture()), 0.001, 1e-15);
  EXPECT_NEAR(thread.suture().length[0], kMinSegment + 0.0005, 1e-15);
  EXPECT_NEAR(drawThread(0.001, thread.suture()), 0.001, 1e-15);
  EXPECT_NEAR(thread.suture().length[0], kMinSegment, 1e-15);
  EXPECT_NEAR(thread.suture().length[1], kMinSegment + 0.0015, 1e-15);
  EXPECT_NEAR(drawThread(1, thread.suture()), 0.0025, 1e-15);
  for (double length : thread.suture().length) EXPECT_NEAR(length, kMinSegment, 1e-15);
  EXPECT_NEAR(thread.suture().pulled, 0.0045, 1e-15);
  EXPECT_EQ(drawThread(1, thread.suture()), 0);
}

TEST(ThreadEvents, TheCinchFeelsTheSegmentItDrawsFrom) {
  Thread thread(kCorner);
  thread.suture().length = {0.010, 0.020, 0.030};
  thread.suture().tension = {2, 5, 7};
  EXPECT_EQ(cinchTension(thread.suture()), 2);
  thread.suture().length[1] = kMinSegment;  // not the first: does not matter
  EXPECT_EQ(cinchTension(thread.suture()), 2);
  thread.suture().length[0] = kMinSegment;  // its bites have met, and so have the next two
  EXPECT_EQ(cinchTension(thread.suture()), 7);
  thread.suture().length[1] = 0.020;
  EXPECT_EQ(cinchTension(thread.suture()), 5);
  thread.suture().tension = {6, 5, 7};
  EXPECT_EQ(cinchTension(thread.suture()), 6);
  thread.suture().tension.clear();
  thread.suture().length.clear();
  EXPECT_EQ(cinchTension(thread.suture()), 0);
}

TEST(ThreadEvents, PutBackToRestAllThreadsAreSlack) {
  Thread thread(kCorner);
  thread.suture().tension = {9, 9, 9};
  thread.suture().length = {0.001, 0.5, 0.001};
  slackenThreads(thread.model, thread.state);
  EXPECT_NEAR(thread.suture().length[2], 0.03, 1e-12);
  EXPECT_NEAR(thread.suture().length[1], 0.5, 1e-12);
  thread.update();
  EXPECT_TRUE(thread.events.empty());
}

}  // namespace
}  // namespace vibe::thread_events_test
