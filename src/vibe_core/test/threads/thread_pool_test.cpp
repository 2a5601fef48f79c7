#include "vibe_core/threads/thread_pool.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "vibe_testing/allocation_count.hpp"

namespace vibe::thread_pool_test {
namespace {

TEST(ThreadPool, DoesEachPieceOnceForAnyNumberOfThreads) {
  for (const int threads : {1, 2, 5}) {
    ThreadPool pool(threads);
    EXPECT_EQ(pool.threads(), threads);
    for (int round = 0; round < 2000; ++round) {
      const int count = round % 40, grain = 1 + round % 3;
      std::vector<int> done(static_cast<std::size_t>(count), 0);  // not atomic: nobody else may touch an item
      pool.parallelFor(count, grain, [&](int first, int last) {
        EXPECT_EQ(first % grain, 0);
        EXPECT_LE(last - first, grain);
        for (int i = first; i < last; ++i) ++done[static_cast<std::size_t>(i)];
      });
      ASSERT_EQ(done, std::vector<int>(static_cast<std::size_t>(count), 1)) << threads << " threads, round " << round;
      if (round % 500 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));  // the others fall asleep
    }
  }
}

TEST(ThreadPool, AnotherThreadTakesPartAlsoAfterAPause) {
  ThreadPool pool(2);
  for (int round = 0; round < 3; ++round) {
    std::atomic<int> begun{0};
    std::atomic<bool> met{true};
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    pool.parallelFor(2, 1, [&](int, int) {
      ++begun;
      while (begun < 2 && met) met = std::chrono::steady_clock::now() < until;
    });
    EXPECT_TRUE(met) << "one thread did both pieces";
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

TEST(ThreadPool, AsksForNoMemory) {
  if (!VIBE_COUNTS_ALLOCATIONS) GTEST_SKIP() << "a sanitizer brings its own memory";
  ThreadPool pool(2);
  std::atomic<int> a{0}, b{0}, c{0}, d{0};
  const auto body = [&](int, int) { ++a, ++b, ++c, ++d; };
  pool.parallelFor(4, 1, body);
  const long before = test::allocations;
  for (int i = 0; i < 10; ++i) pool.parallelFor(4, 1, body);
  EXPECT_EQ(test::allocations, before);
  EXPECT_EQ(d, 44);
}

}  // namespace
}  // namespace vibe::thread_pool_test
