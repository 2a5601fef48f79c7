#include "camera/frame_timing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace vibe::vision::stamp_clock_test {

namespace {

constexpr double kUnix = 1.7e9;
constexpr double kPeriod = 1.0 / 147;
constexpr double kSmallest = 5e-5;  // delay of a packet [s]

/// A camera whose clock shows (t - zero) (1 + drift) at time t; packets are late by a random time.
class Camera {
 public:
  double zero = kUnix - 1000, drift = 0;

  /// @return error of the mapped stamp
  double frame(StampClock& clock, double t) {
    std::exponential_distribution<double> extra(1 / 2e-3);  // mean of 2 ms: a busy host
    const double device = (t - zero) * (1 + drift);
    return clock.map(device, t + kSmallest + extra(random_)) - t;
  }

  /// @return largest error from `settle` on
  double run(StampClock& clock, double begin, double duration, double settle) {
    double worst = 0;
    for (double t = begin; t < begin + duration; t += kPeriod) {
      const double error = frame(clock, t);
      if (t > begin + settle) worst = std::max(worst, std::abs(error));
    }
    return worst;
  }

 private:
  std::mt19937 random_{1};
};

}  // namespace

TEST(StampClock, DelaysOfMillisecondsDoNotReachTheStamps) {
  Camera camera;
  StampClock clock;
  EXPECT_LT(camera.run(clock, kUnix, 30, 5), 3e-4);
}

TEST(StampClock, DriftIsFollowed) {
  Camera camera;
  camera.drift = 5e-5;  // 3 ms in a minute
  StampClock clock;
  EXPECT_LT(camera.run(clock, kUnix, 120, 10), 5e-4);
}

TEST(StampClock, AResetOfTheCamerasClockIsNoticedAtOnce) {
  Camera camera;
  StampClock clock;
  camera.run(clock, kUnix, 10, 0);
  camera.zero = kUnix + 10;
  EXPECT_LT(camera.run(clock, kUnix + 10, 10, 0), 0.05);
  EXPECT_LT(camera.run(clock, kUnix + 20, 10, 0), 3e-4);
}

TEST(StampClock, AClockThatIsSetForwardIsNoticedAtOnce) {
  Camera camera;
  StampClock clock;
  camera.run(clock, kUnix, 10, 0);
  camera.zero = kUnix - 1e6;
  EXPECT_LT(camera.run(clock, kUnix + 10, 10, 0), 0.05);
}

TEST(StampClock, ASmallStepForwardIsNotTakenForDrift) {
  Camera camera;
  StampClock clock;
  camera.run(clock, kUnix, 110, 0);
  camera.zero -= 0.08;
  camera.run(clock, kUnix + 110, 5, 0);
  EXPECT_LT(camera.run(clock, kUnix + 115, 10, 0), 5e-4);
}

TEST(StampClock, AStallOfTheHostDoesNotShiftTheStamps) {
  Camera camera;
  StampClock clock;
  camera.run(clock, kUnix, 10, 0);
  const double late = kUnix + 10;
  EXPECT_NEAR(clock.map(late - camera.zero, late + 0.4), late, 3e-4);
  EXPECT_LT(camera.run(clock, late + kPeriod, 5, 0), 3e-4);
}

TEST(StampClock, ACameraThatFollowsPtpIsTakenAtItsWord) {
  Camera camera;
  camera.zero = 0;
  StampClock clock(CameraClock::Auto, true);
  EXPECT_LT(camera.run(clock, kUnix, 1, 0), 1e-6);
  EXPECT_TRUE(clock.isHostTime());
}

TEST(StampClock, PtpMayBeTaiWhichIs37SecondsAhead) {
  Camera camera;
  camera.zero = -37;
  StampClock clock(CameraClock::Auto, true);
  EXPECT_LT(camera.run(clock, kUnix, 1, 0), 1e-6);
}

TEST(StampClock, WithoutPtpAClockNearUnixTimeIsNotBelieved) {
  Camera camera;
  camera.zero = 0.2;  // set by hand
  StampClock clock;
  EXPECT_LT(camera.run(clock, kUnix, 10, 5), 5e-4);
  EXPECT_FALSE(clock.isHostTime());
}

TEST(StampClock, PtpWithStampsFromTheFutureIsNotBelieved) {
  Camera camera;
  camera.zero = -0.3;
  StampClock clock(CameraClock::Auto, true);
  EXPECT_LT(camera.run(clock, kUnix, 10, 5), 5e-4);
  EXPECT_FALSE(clock.isHostTime());
}

}  // namespace vibe::vision::stamp_clock_test
