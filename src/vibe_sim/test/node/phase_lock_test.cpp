// Steps that begin when samples arrive.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include "simulator/phase_lock.hpp"

namespace vibe::sim::phase_lock_test {
namespace {

constexpr std::int64_t kPeriod = 10'000'000;  // of the steps [ns]
constexpr double kStart = 1.7e18;             // a wall time of today [ns]

/// A device whose samples arrive a fixed time after a regular clock, with some jitter and now and then much too late.
struct Device {
  double period = 1e7;  // [ns]
  double phase = 0;     // [ns]
  double jitter = 1e5;  // standard deviation [ns]
  double late = 0;      // share of samples that are 4 ms late
};

/// Runs steps for some seconds. @return where the deadline ends up, after the device's clock, in [0, kPeriod) [ns]
class Session {
 public:
  explicit Session(std::vector<Device> devices, double deadline = 0) : devices_(std::move(devices)), deadline_(0) {
    deadline_ = static_cast<std::int64_t>(kStart + deadline);
    for (const Device& device : devices_) next_.push_back(kStart + device.phase);
  }

  double settle(double seconds) {
    const auto end = deadline_ + static_cast<std::int64_t>(1e9 * seconds);
    while (deadline_ < end) {
      arrivals();
      const std::int64_t correction = lock_.correction(deadline_);
      largest_ = std::max(largest_, std::abs(correction));
      deadline_ += kPeriod + correction;
    }
    double phase = std::fmod(static_cast<double>(deadline_ - static_cast<std::int64_t>(kStart)), 1e7);
    return phase < 0 ? phase + 1e7 : phase;
  }

  std::int64_t largest() const { return largest_; }
  PhaseLock& lock() { return lock_; }
  std::int64_t deadline() const { return deadline_; }

 private:
  std::vector<Device> devices_;
  std::vector<double> next_;
  std::int64_t deadline_, largest_ = 0;
  PhaseLock lock_{kPeriod};
  std::mt19937 random_{1};

  void arrivals() {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    std::vector<std::int64_t> times;
    for (std::size_t i = 0; i < devices_.size(); ++i) {
      for (; next_[i] < static_cast<double>(deadline_); next_[i] += devices_[i].period) {
        const double delay =
            devices_[i].jitter * std::abs(normal(random_)) + (uniform(random_) < devices_[i].late ? 4e6 : 0);
        times.push_back(static_cast<std::int64_t>(next_[i] + delay));
      }
    }
    std::sort(times.begin(), times.end());
    for (const std::int64_t time : times) lock_.arrive(time);
  }
};

TEST(PhaseLock, StepsBeginJustAfterTheirSamples) {
  for (const double start : {0.0, 2e6, 5.1e6, 9e6}) {
    Session run({{1e7, 3e6}}, start);
    EXPECT_NEAR(run.settle(5), 3.3e6, 2e5) << start;
    EXPECT_LE(run.largest(), kPeriod / 500);
  }
}

TEST(PhaseLock, ADeviceAtAWholeMultipleWillDo) {
  Session run({{5e6, 1e6}}, 3e6);
  const double phase = std::fmod(run.settle(5), 5e6);
  EXPECT_NEAR(phase, 1.3e6, 2e5);
}

TEST(PhaseLock, OtherRatesLeaveTheStepsAlone) {
  for (const double period : {1e6, 1e9 / 60, 1e9 / 90, 1e9 / 101, 1e9 / 103}) {
    Session run({{period, 3e6}}, 7e6);
    EXPECT_LT(std::abs(run.settle(5) - 7e6), 1e3) << period;
  }
}

TEST(PhaseLock, LateSamplesNowAndThenDoNotMatter) {
  Session run({{1e7, 3e6, 1e5, 0.02}}, 0);
  EXPECT_NEAR(run.settle(10), 3.3e6, 4e5);
}

TEST(PhaseLock, FollowsAClockThatGoesWrong) {
  Session run({{1e7 * (1 + 3e-4), 3e6}}, 0);
  const double before = run.settle(20), drift = 20e9 * 3e-4;
  EXPECT_NEAR(std::fmod(before - drift - 3e6 + 1e8, 1e7), 0.3e6, 3e5);
}

// The one that comes soon after the other: the step uses both.
TEST(PhaseLock, WaitsForTheLastOfTwoDevices) {
  Session run({{1e7, 1e6}, {1e7, 3e6}}, 0);
  EXPECT_NEAR(run.settle(6), 3.3e6, 2e5);
}

TEST(PhaseLock, WithoutSamplesNothingMoves) {
  PhaseLock lock(kPeriod);
  EXPECT_EQ(lock.correction(1'000'000'000), 0);
  for (int i = 0; i < 200; ++i) lock.arrive(i * kPeriod);
  EXPECT_NE(lock.correction(200 * kPeriod + 5'000'000), 0);
  EXPECT_EQ(lock.correction(300 * kPeriod), 0);  // a second of silence
}

TEST(PhaseLock, AStepWaitsALittleForASampleThatIsLate) {
  PhaseLock lock(kPeriod);
  for (int i = 0; i <= 140; ++i) lock.arrive(i * kPeriod);
  const std::int64_t deadline = 141 * kPeriod + 200'000;
  EXPECT_TRUE(lock.awaits(deadline, deadline));
  EXPECT_TRUE(lock.awaits(deadline, deadline + 900'000));
  EXPECT_FALSE(lock.awaits(deadline, deadline + 1'100'000));
  lock.arrive(141 * kPeriod + 300'000);
  EXPECT_FALSE(lock.awaits(deadline, deadline + 300'000));
}

TEST(PhaseLock, NoStepWaitsForASampleOfASlowerDevice) {
  PhaseLock lock(kPeriod);
  for (int i = 0; i <= 140; ++i) lock.arrive(2 * i * kPeriod);
  const std::int64_t deadline = 281 * kPeriod + 200'000;
  EXPECT_NE(lock.correction(deadline + kPeriod / 2), 0);  // its steps do follow
  EXPECT_FALSE(lock.awaits(deadline, deadline));
}

}  // namespace
}  // namespace vibe::sim::phase_lock_test
