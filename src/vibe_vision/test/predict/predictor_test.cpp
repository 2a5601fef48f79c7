#include "vibe_vision/predict/predictor.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "predict/reach.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::vision::predictor_test {
namespace {

constexpr double kStep = 1 / 147.0;  // [s]
constexpr double kLead = 0.014;      // [s]
constexpr double kNoise = 3e-6;      // [m]

TEST(Predictor, FollowsAParabolaExactly) {
  const MotionPrior smooth{{1e-6, 0.02}, 1e4, 1e4, 1};
  Predictor predictor(smooth);
  const auto at = [](double t) { return 0.01 + 0.2 * t - 1.5 * t * t; };
  for (int k = 0; k < 20; ++k) predictor.update(k * kStep, at(k * kStep), 1e-12);
  const MotionEstimate later = predictor.predict(19 * kStep + 0.1);
  EXPECT_NEAR(later.mean(0), at(later.time), 1e-6);
  EXPECT_NEAR(later.mean(1), 0.2 - 3 * later.time, 1e-4);
  EXPECT_NEAR(later.mean(2), -3, 1e-3);
}

TEST(Predictor, WithoutJerkItIsTheFitOfAParabola) {
  // variance of a parabola fitted to n evenly spaced values, at the last of them
  const MotionPrior smooth{{1e-6, 0.02}, 30, 3000, 1};
  Predictor predictor(smooth);
  for (int n = 1; n <= 30; ++n) {
    predictor.update(n * kStep, 0, kNoise * kNoise);
    if (n < 4) continue;
    const double expected = 3.0 * (3 * n * n - 3 * n + 2) / (n * (n + 1.0) * (n + 2.0)) * kNoise * kNoise;
    EXPECT_NEAR(predictor.predict(n * kStep).covariance(0, 0) / expected, 1, 1e-3) << n;
  }
}

/// Draws a motion whose jerk is a Gauss-Markov process, in steps that are short against everything else.
class RandomMotion {
 public:
  RandomMotion(const MotionPrior& prior, std::mt19937_64& random) : jerk_(prior.jerk), random_(random) {
    state_ << 0, prior.speed * normal_(random_), prior.acceleration * normal_(random_),
        prior.jerk.deviation * normal_(random_);
  }
  const Eigen::Vector4d& advance(double dt) {
    const int steps = std::max(1, static_cast<int>(dt / 2e-5));
    const double h = dt / steps, decay = std::exp(-h / jerk_.time);
    for (int i = 0; i < steps; ++i) {
      state_(0) += h * (state_(1) + h / 2 * (state_(2) + h / 3 * state_(3)));
      state_(1) += h * (state_(2) + h / 2 * state_(3));
      state_(2) += h * state_(3);
      state_(3) = decay * state_(3) + jerk_.deviation * std::sqrt(1 - decay * decay) * normal_(random_);
    }
    return state_;
  }

 private:
  JerkModel jerk_;
  std::mt19937_64& random_;
  std::normal_distribution<double> normal_;
  Eigen::Vector4d state_;
};

/// Mean over independent runs of the normalised squared error of a prediction by kLead, after unevenly spaced and
/// missing measurements.
double meanNees(const MotionPrior& truth, const MotionPrior& assumed, int runs) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  double sum = 0;
  for (int run = 0; run < runs; ++run) {
    RandomMotion motion(truth, random);
    Predictor predictor(assumed);
    double time = 0;
    for (int k = 0; k < 12; ++k) {
      const double dt = kStep * (0.5 + uniform(random)) * (uniform(random) < 0.2 ? 4 : 1);
      time += dt;
      predictor.update(time, motion.advance(dt)(0) + kNoise * normal(random), kNoise * kNoise);
    }
    const MotionEstimate estimate = predictor.predict(time + kLead);
    const Eigen::Vector4d error = estimate.mean - motion.advance(kLead);
    sum += error.dot(estimate.covariance.ldlt().solve(error));
  }
  return sum / runs;
}

TEST(Predictor, CovarianceIsThatOfTheErrors) {
  constexpr int kRuns = 1000;
  const boost::math::chi_squared distribution(4 * kRuns);
  const double low = quantile(distribution, 0.025) / kRuns, high = quantile(distribution, 0.975) / kRuns;
  const double nees = meanNees(kSlidePrior, kSlidePrior, kRuns);
  EXPECT_GT(nees, low);
  EXPECT_LT(nees, high);
  MotionPrior wild = kSlidePrior;  // the test sees a motion with 1.5 times the jerk
  wild.jerk.deviation *= 1.5;
  EXPECT_GT(meanNees(wild, kSlidePrior, kRuns), high);
}

/// RMS error of predictions of reaches [m]. @param missing  share of frames without a measurement
double reachError(std::uint64_t seed, double lead, double noise, double missing = 0) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  const Reach reach{uniform(random), 6 * uniform(random)};
  Predictor predictor(kSlidePrior);
  double sum = 0;
  int count = 0;
  for (int k = 0; k < 147 * 10; ++k) {
    const double time = k * kStep;
    if (uniform(random) >= missing) predictor.update(time, reach(time) + noise * normal(random), noise * noise);
    if (k < 20) continue;
    const double error = predictor.predict(time + lead).mean(0) - reach(time + lead);
    sum += error * error;
    ++count;
  }
  return std::sqrt(sum / count);
}

TEST(Predictor, ErrorOfReachesAt14MillisecondsIsBelow50Micrometres) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const double error = reachError(seed, kLead, kNoise);
    EXPECT_LT(error, 5e-5) << seed;
    EXPECT_GT(error, 1e-5) << "too good to be true, seed " << seed;
    EXPECT_LT(reachError(seed, kLead, 1e-6), 3.5e-5) << seed;
  }
}

TEST(Predictor, NothingIsLostByFilteringTheMeasurement) {
  EXPECT_LT(reachError(3, 0, kNoise), kNoise);
}

TEST(Predictor, EveryFifthFrameMayBeMissing) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) EXPECT_LT(reachError(seed, kLead, kNoise, 0.2), 1e-4) << seed;
}

TEST(Predictor, CovarianceOfReachesIsNotTooSmall) {
  const Reach reach{0.1, 1};
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  Predictor predictor(kSlidePrior);
  double sum = 0;
  constexpr int kFrames = 3000;
  for (int k = 0; k < kFrames; ++k) {
    predictor.update(k * kStep, reach(k * kStep) + kNoise * normal(random), kNoise * kNoise);
    const MotionEstimate estimate = predictor.predict(k * kStep + kLead);
    const double error = estimate.mean(0) - reach(estimate.time);
    sum += error * error / estimate.covariance(0, 0);
  }
  EXPECT_LT(sum / kFrames, 1.5);
  EXPECT_GT(sum / kFrames, 0.3);
}

TEST(Predictor, UncertaintyGrowsWithoutMeasurements) {
  Predictor predictor(kSlidePrior);
  for (int k = 0; k < 50; ++k) predictor.update(k * kStep, 0, kNoise * kNoise);
  double last = 0;
  for (int k = 0; k < 30; ++k) {
    const double variance = predictor.predict((49 + k) * kStep).covariance(0, 0);
    EXPECT_GT(variance, last);
    last = variance;
  }
}

TEST(Predictor, StartsAnewAfterALongGap) {
  Predictor predictor(kSlidePrior);
  for (int k = 0; k < 50; ++k) predictor.update(k * kStep, 0.2 * k * kStep, kNoise * kNoise);
  predictor.update(49 * kStep + 0.3, -0.02, kNoise * kNoise);
  const MotionEstimate estimate = predictor.predict(49 * kStep + 0.3);
  EXPECT_EQ(estimate.mean(0), -0.02);
  EXPECT_EQ(estimate.mean(1), 0);
  EXPECT_DOUBLE_EQ(estimate.covariance(1, 1), kSlidePrior.speed * kSlidePrior.speed);
}

TEST(Predictor, UnusableMeasurementsChangeNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Predictor predictor(kSlidePrior);
  EXPECT_TRUE(predictor.empty());
  for (int k = 0; k < 5; ++k) EXPECT_TRUE(predictor.update(k * kStep, 0.01 * k, kNoise * kNoise));
  const MotionEstimate before = predictor.predict(1);
  EXPECT_FALSE(predictor.update(4 * kStep, 1, kNoise * kNoise));  // not later
  EXPECT_FALSE(predictor.update(3 * kStep, 1, kNoise * kNoise));
  EXPECT_FALSE(predictor.update(5 * kStep, nan, kNoise * kNoise));
  EXPECT_FALSE(predictor.update(nan, 0, kNoise * kNoise));
  EXPECT_FALSE(predictor.update(5 * kStep, 0, 0));
  EXPECT_FALSE(predictor.update(5 * kStep, 0, nan));
  EXPECT_EQ(predictor.predict(1).mean, before.mean);
  EXPECT_EQ(predictor.predict(1).covariance, before.covariance);
  predictor.reset();
  EXPECT_TRUE(predictor.empty());
}

TEST(Predictor, RefusesAPriorThatMeansNothing) {
  MotionPrior prior = kSlidePrior;
  prior.jerk.deviation = 0;
  EXPECT_THROW(Predictor{prior}, Error);
  prior = kSlidePrior;
  prior.speed = std::numeric_limits<double>::infinity();
  EXPECT_THROW(Predictor{prior}, Error);
}

}  // namespace
}  // namespace vibe::vision::predictor_test
