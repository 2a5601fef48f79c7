// What trainee/progress says, from the first goal to the end of a session.
#include "trainee/goal_book.hpp"

#include <gtest/gtest.h>

#include "vibe_core/simulation/simulation.hpp"

namespace vibe::sim::goal_book_test {
namespace {

using Entry = vibe_msgs::GoalProgress;

struct Bench {
  Bench() : simulation(vibe::loadModel("node/scenes/balloon.yaml")), trainee(begin()) {}

  std::unique_ptr<Trainee> begin() const {
    return std::make_unique<Trainee>(simulation.sharedModel(), Skill::expert(), 1);
  }
  void steps(int count) {
    for (int k = 0; k < count; ++k) {
      const Observation seen = observe(simulation);
      simulation.step(trainee->next(seen));
      book.follow(*trainee, seen);
    }
  }
  const Entry& entry(std::uint32_t id) const { return book.message().goals.at(id - 1); }

  Simulation simulation;
  std::unique_ptr<Trainee> trainee;
  GoalBook book;
};

TEST(GoalBook, GoalsBecomeActiveAndEndInTurn) {
  Bench bench;
  const std::uint32_t first = bench.book.add("one", WaitGoal{0.5}), second = bench.book.add("", WaitGoal{0.5});
  EXPECT_EQ(first, 1u);
  EXPECT_EQ(second, 2u);
  EXPECT_EQ(bench.entry(1).state, Entry::QUEUED);
  bench.book.start(*bench.trainee);
  bench.steps(10);
  EXPECT_EQ(bench.entry(1).state, Entry::ACTIVE);
  EXPECT_EQ(bench.entry(1).activity, "wait");
  EXPECT_EQ(bench.entry(1).label, "one");
  EXPECT_EQ(bench.entry(2).state, Entry::QUEUED);
  bench.steps(30);
  EXPECT_EQ(bench.entry(1).state, Entry::REACHED);
  EXPECT_EQ(bench.entry(1).activity, "");
  EXPECT_EQ(bench.entry(2).state, Entry::ACTIVE);
  const std::uint32_t third = bench.book.add("", CinchGoal{});
  bench.book.start(*bench.trainee);
  bench.steps(240);
  EXPECT_EQ(bench.entry(2).state, Entry::REACHED);
  EXPECT_EQ(bench.entry(third).state, Entry::FAILED) << "there is no bite";
  EXPECT_FALSE(bench.entry(third).reason.empty());
}

TEST(GoalBook, OnlyChangesAreSent) {
  Bench bench;
  EXPECT_TRUE(bench.book.takeChange()) << "the first, empty message";
  EXPECT_FALSE(bench.book.takeChange());
  bench.book.add("", WaitGoal{0.5});
  EXPECT_TRUE(bench.book.takeChange());
  bench.book.start(*bench.trainee);
  int changes = 0;
  for (int k = 0; k < 60; ++k) {
    bench.steps(1);
    changes += bench.book.takeChange() ? 1 : 0;
  }
  EXPECT_EQ(changes, 2) << "active, reached";
}

TEST(GoalBook, CancelsOneOrAll) {
  Bench bench;
  for (int k = 0; k < 4; ++k) bench.book.add("", WaitGoal{100});
  EXPECT_TRUE(bench.book.cancel(4, nullptr)) << "before a trainee begins";
  bench.book.start(*bench.trainee);
  bench.steps(5);
  EXPECT_TRUE(bench.book.cancel(2, bench.trainee.get()));
  EXPECT_EQ(bench.entry(2).state, Entry::FAILED);
  EXPECT_EQ(bench.entry(2).reason, "cancelled");
  EXPECT_EQ(bench.entry(1).state, Entry::ACTIVE);
  EXPECT_FALSE(bench.book.cancel(2, bench.trainee.get())) << "it has ended";
  EXPECT_FALSE(bench.book.cancel(9, bench.trainee.get()));
  EXPECT_TRUE(bench.book.cancel(0, bench.trainee.get()));
  bench.steps(200);
  for (const std::uint32_t id : {1u, 2u, 3u, 4u}) {
    EXPECT_EQ(bench.entry(id).state, Entry::FAILED) << id;
    EXPECT_EQ(bench.entry(id).reason, "cancelled") << id;
  }
  EXPECT_EQ(bench.trainee->goals().size(), 3u) << "the fourth never reached the trainee";
}

TEST(GoalBook, ANewSessionBeginsWithNewGoals) {
  Bench bench;
  bench.book.add("", WaitGoal{0.1});
  bench.book.add("", WaitGoal{100});
  bench.book.start(*bench.trainee);
  bench.steps(30);
  bench.book.abandon("the session has ended");
  EXPECT_EQ(bench.entry(1).state, Entry::REACHED);
  EXPECT_EQ(bench.entry(2).state, Entry::FAILED);
  EXPECT_EQ(bench.entry(2).reason, "the session has ended");
  bench.trainee = bench.begin();
  const std::uint32_t id = bench.book.add("", WaitGoal{0.1});
  EXPECT_EQ(id, 3u);
  bench.book.start(*bench.trainee);
  bench.steps(30);
  EXPECT_EQ(bench.entry(3).state, Entry::REACHED);
  EXPECT_EQ(bench.trainee->goals().size(), 1u);
}

TEST(GoalBook, RefusedGoalsAreThereWithTheirReason) {
  GoalBook book;
  book.refuse("mine", "byte", "no such goal");
  const Entry& entry = book.message().goals.at(0);
  EXPECT_EQ(entry.state, Entry::FAILED);
  EXPECT_EQ(entry.label, "mine");
  EXPECT_EQ(entry.goal, "byte");
  EXPECT_EQ(entry.reason, "no such goal");
  EXPECT_EQ(entry.suture, -1);
}

TEST(GoalBook, ABiteTellsWhichSutureIsThatOfTheGoal) {
  Bench bench;
  SutureSetGoal set;
  set.pattern = Technique::Z;
  const std::uint32_t id = bench.book.add("", WaitGoal{100});
  EXPECT_EQ(bench.book.add("", set), 2u);
  EXPECT_EQ(bench.entry(2).pattern, "z");
  bench.book.start(*bench.trainee);
  bench.steps(2);
  EXPECT_EQ(bench.entry(id).suture, -1);
  Observation seen = observe(bench.simulation);
  seen.sets = 3;
  seen.events.emplace_back().kind = Event::Kind::Bite;
  bench.book.follow(*bench.trainee, seen);
  EXPECT_EQ(bench.entry(id).suture, 2);
  EXPECT_EQ(bench.entry(2).suture, -1);
}

}  // namespace
}  // namespace vibe::sim::goal_book_test
