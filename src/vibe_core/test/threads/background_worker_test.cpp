#include "threads/background_worker.hpp"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "vibe_testing/allocation_count.hpp"

namespace vibe::background_worker_test {
namespace {

int priorityHere() {
  int policy = SCHED_OTHER;
  sched_param parameters{};
  ::pthread_getschedparam(::pthread_self(), &policy, &parameters);
  return policy == SCHED_OTHER ? 0 : parameters.sched_priority;
}

bool takePriority(int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  return ::pthread_setschedparam(::pthread_self(), priority > 0 ? SCHED_FIFO : SCHED_OTHER, &parameters) == 0;
}

TEST(BackgroundWorker, DoesItsJobOncePerStart) {
  int done = 0;
  BackgroundWorker worker([&] { ++done; });
  worker.finish();
  EXPECT_EQ(done, 0) << "nothing was begun";
  for (int i = 1; i <= 100; ++i) {
    worker.start();
    worker.finish();
    worker.finish();
    EXPECT_EQ(done, i);
  }
}

TEST(BackgroundWorker, StartWaitsForTheJobBefore) {
  std::atomic<int> at_once{0}, most{0}, done{0};
  BackgroundWorker worker([&] {
    most = std::max(most.load(), ++at_once);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    --at_once;
    ++done;
  });
  for (int i = 0; i < 5; ++i) worker.start();
  worker.finish();
  EXPECT_EQ(most, 1);
  EXPECT_EQ(done, 5);
}

TEST(BackgroundWorker, WorksBesideItsCaller) {
  std::atomic<bool> may_end{false};
  BackgroundWorker worker([&] {
    while (!may_end) std::this_thread::yield();
  });
  worker.start();  // would not return if the job ran here
  may_end = true;
  worker.finish();
}

TEST(BackgroundWorker, ThrowsOnceWhatTheJobHasThrown) {
  bool fails = true;
  BackgroundWorker worker([&] {
    if (fails) throw std::runtime_error("as asked for");
  });
  worker.start();
  EXPECT_THROW(worker.finish(), std::runtime_error);
  worker.finish();
  fails = false;
  worker.start();
  worker.finish();
}

TEST(BackgroundWorker, EndsWithAJobUnderWayAndWithoutAny) {
  std::atomic<bool> done{false};
  {
    BackgroundWorker worker([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      done = true;
    });
    worker.start();
  }
  EXPECT_TRUE(done);
  const BackgroundWorker idle([] {});
}

TEST(BackgroundWorker, StartAndFinishAskForNoMemory) {
  if (!VIBE_COUNTS_ALLOCATIONS) GTEST_SKIP() << "a sanitizer brings its own memory";
  BackgroundWorker worker([] {});
  worker.start();  // makes the thread
  const long before = test::allocations;
  for (int i = 0; i < 10; ++i) worker.start();
  worker.finish();
  EXPECT_EQ(test::allocations, before);
}

TEST(BackgroundWorker, HasTheLowestPriorityUntilSomebodyWaits) {
  if (!takePriority(20)) GTEST_SKIP() << "real-time priority is not permitted here";
  std::atomic<int> at_first{-1}, at_last{-1};
  std::atomic<bool> has_begun{false};
  BackgroundWorker worker([&] {
    at_first = priorityHere();
    has_begun = true;
    for (int i = 0; i < 2000 && priorityHere() == at_first; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    at_last = priorityHere();
  });
  worker.start();
  while (!has_begun) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  worker.finish();
  EXPECT_EQ(at_first, ::sched_get_priority_min(SCHED_FIFO));
  EXPECT_EQ(at_last, 20);

  takePriority(0);
  worker.start();
  worker.finish();  // waits until the priority changes, or for two seconds
  EXPECT_EQ(at_first, 0) << "an ordinary thread gives no priority";
}

}  // namespace
}  // namespace vibe::background_worker_test
