#include "vibe_core/clocks/device_clock.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace vibe::device_clock_test {
namespace {

constexpr double kPeriod = 0.01;
constexpr double kSmallestDelay = 0.3e-3;

/// A busy host: 0.3 ms, polling, scheduling with a mean of 1 ms, and each 50th report late by up to 100 ms. Reports do
/// not overtake each other.
class Link {
 public:
  explicit Link(double polling) : polling_(polling) {}

  double arrival(double sent) {
    const double poll = polling_ > 0 ? polling_ * std::ceil(sent / polling_) - sent : 0;
    double delay = kSmallestDelay + poll + scheduling_(random_);
    if (late_(random_)) delay += stall_(random_);
    last_ = std::max(last_, sent + delay);
    return last_;
  }

 private:
  double polling_;
  std::mt19937 random_{3};
  std::exponential_distribution<double> scheduling_{1000};
  std::bernoulli_distribution late_{0.02};
  std::uniform_real_distribution<double> stall_{0, 0.1};
  double last_ = 0;
};

struct Errors {
  double mean = 0, deviation = 0, max = 0;
};

Errors summarize(const std::vector<double>& values) {
  Errors e;
  for (const double v : values) e.mean += v / static_cast<double>(values.size());
  double square = 0;
  for (const double v : values) square += (v - e.mean) * (v - e.mean) / static_cast<double>(values.size());
  for (const double v : values) e.max = std::max(e.max, std::abs(v));
  e.deviation = std::sqrt(square);
  return e;
}

/// Error of the stamps between two times, for a device whose clock gains `ppm`; and that of the times of arrival.
std::pair<Errors, Errors> measure(double polling, double ppm, double from, double to) {
  const double rate = 1 + 1e-6 * ppm;
  DeviceClock clock;
  Link link(polling);
  std::vector<double> errors, late;
  for (int k = 0; k * kPeriod < to; ++k) {
    const double sampled = 1000 + k * kPeriod / rate;
    const double arrival = link.arrival(sampled);
    clock.add(5 + k * kPeriod, arrival);
    if (k * kPeriod < from) continue;
    errors.push_back(std::min(clock.hostTime(5 + k * kPeriod), arrival) - sampled);
    late.push_back(arrival - sampled);
  }
  return {summarize(errors), summarize(late)};
}

std::string describe(const char* what, double polling, double ppm, const Errors& e) {
  char text[200];
  std::snprintf(text, sizeof text,
                "%s, polled each %.0f ms, drift %+.0f ppm: mean %.0f us, deviation %.0f us, max %.0f us", what,
                1e3 * polling, ppm, 1e6 * e.mean, 1e6 * e.deviation, 1e6 * e.max);
  std::puts(text);
  return text;
}

TEST(DeviceClock, StampsAreThoseOfTheSampleOverALinkWithJitter) {
  for (const double ppm : {0.0, 100.0, -100.0, 30.0}) {
    const auto [stamps, arrivals] = measure(0, ppm, 5, 300);
    SCOPED_TRACE(describe("stamps", 0, ppm, stamps) + "\n" + describe("arrivals", 0, ppm, arrivals));
    EXPECT_GT(stamps.mean, 0) << "a report cannot arrive before it was sent";
    EXPECT_LT(stamps.mean, kSmallestDelay + 0.05e-3);
    EXPECT_LT(stamps.deviation, 0.05e-3);
    EXPECT_LT(stamps.max, 0.6e-3);
    EXPECT_GT(arrivals.deviation, 5e-3) << "the link of this test does not jitter";
  }
}

TEST(DeviceClock, PollingIsVisibleOnlyUntilItsPhaseHasDriftedThrough) {
  for (const double ppm : {100.0, -100.0, 40.0}) {
    const Errors early = measure(4e-3, ppm, 1, 60).first, late = measure(4e-3, ppm, 120, 600).first;
    SCOPED_TRACE(describe("first minute", 4e-3, ppm, early) + "\n" + describe("after two", 4e-3, ppm, late));
    EXPECT_LT(early.max, kSmallestDelay + 2.5e-3);
    EXPECT_LT(late.mean, kSmallestDelay + 0.2e-3);
    EXPECT_LT(late.deviation, 0.1e-3);
    EXPECT_LT(late.max, 1e-3);
  }
  describe("first minute", 4e-3, 0, measure(4e-3, 0, 1, 60).first);
  describe("after two", 4e-3, 10, measure(4e-3, 10, 120, 600).first);
}

TEST(DeviceClock, MapsBothWays) {
  DeviceClock clock;
  for (int k = 0; k < 1000; ++k) clock.add(5 + k * kPeriod, 1000 + k * kPeriod * 1.0001);
  EXPECT_NEAR(clock.hostTime(15), 1000 + 10 * 1.0001, 1e-5);
  EXPECT_NEAR(clock.deviceTime(clock.hostTime(12.345)), 12.345, 1e-9);
}

TEST(DeviceClock, FollowsADeviceThatWasStoppedAndGoesOn) {
  DeviceClock clock;
  double host = 1000;
  double device = 0;
  const auto run = [&](double seconds) {
    for (int k = 0; k < seconds / kPeriod; ++k) {
      clock.add(device, host);
      device += kPeriod;
      host += kPeriod;
    }
  };
  run(10);
  host += 3;  // its clock stood still
  run(1);
  EXPECT_NEAR(clock.hostTime(device), host, 1e-3);
}

TEST(DeviceClock, ABurstOfOldReportsIsNoStep) {
  DeviceClock clock;
  for (int k = 0; k < 1000; ++k) clock.add(k * kPeriod, 1000 + k * kPeriod);
  for (int k = 1000; k < 1064; ++k) clock.add(k * kPeriod, 1000 + 1064 * kPeriod);  // the host had stalled
  EXPECT_NEAR(clock.hostTime(1064 * kPeriod), 1000 + 1064 * kPeriod, 1e-3);
}

TEST(DeviceClock, ABacklogThatIsReadSlowlyIsNoStep) {
  DeviceClock clock;
  for (int k = 0; k < 1000; ++k) clock.add(k * kPeriod, 1000 + k * kPeriod);
  for (int k = 1000; k < 1400; ++k) {  // the host stalled for 2 s and then reads twice as fast as the device sends
    const double arrival = 1000 + (1200 + 0.5 * (k - 1000)) * kPeriod;
    clock.add(k * kPeriod, arrival);
    ASSERT_NEAR(clock.hostTime(k * kPeriod), 1000 + k * kPeriod, 1e-3) << k;
  }
}

}  // namespace
}  // namespace vibe::device_clock_test
