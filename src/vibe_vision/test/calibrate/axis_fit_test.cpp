#include "vibe_vision/calibrate/axis_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "calibrate/fitting.hpp"
#include "vibe_testing/expect_error.hpp"

namespace vibe::vision::axis_fit_test {
namespace {

SlideAxis slantedAxis() {
  SlideAxis axis;
  axis.origin = {200, 300};
  axis.direction = Eigen::Vector2d(std::cos(-0.3), std::sin(-0.3));
  axis.pixels_per_metre = 10300;
  axis.perspective = 0.8;
  return axis;
}

/// Stops over 30 mm with Gaussian errors along and across the axis.
std::vector<AxisStop> stopsOf(const SlideAxis& axis, std::size_t count, double along_error, double across_error,
                              unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<AxisStop> stops;
  const Eigen::Vector2d d = axis.direction, n(-d.y(), d.x());
  for (std::size_t i = 0; i < count; ++i) {
    AxisStop stop;
    stop.name = "stop " + std::to_string(i);
    stop.slide = -5e-3 + 30e-3 * static_cast<double>(i) / static_cast<double>(count - 1);
    stop.pixel = axis.origin + (alongOf(axis, stop.slide) + along_error * normal(random)) * d;
    stop.pixel += across_error * normal(random) * n;
    stops.push_back(stop);
  }
  return stops;
}

double angleOf(const SlideAxis& axis) {
  return std::atan2(axis.direction.y(), axis.direction.x());
}

TEST(StudentT, TailsAreThoseOfTables) {
  EXPECT_NEAR(studentTail(12.706, 1), 0.05, 1e-5);
  EXPECT_NEAR(studentTail(2.776, 4), 0.05, 5e-5);
  EXPECT_NEAR(studentTail(-3.169, 10), 0.01, 1e-5);
  EXPECT_NEAR(studentTail(1.96, 100000), 0.05, 1e-4);
}

TEST(StudentT, TheQuantileIsTheInverseOfTheTail) {
  EXPECT_NEAR(studentQuantile(0.05, 2), 4.3027, 1e-4);
  EXPECT_NEAR(studentQuantile(0.01, 30), 2.75, 1e-3);
}

TEST(AxisFit, ExactStopsGiveTheAxis) {
  const SlideAxis truth = slantedAxis();
  const AxisFit fit = fitAxis(stopsOf(truth, 7, 0, 0, 1));
  EXPECT_TRUE(fit.perspective_observed);
  EXPECT_LT((fit.axis.origin - truth.origin).norm(), 1e-7);
  EXPECT_NEAR(angleOf(fit.axis), angleOf(truth), 1e-10);
  EXPECT_NEAR(fit.axis.pixels_per_metre, truth.pixels_per_metre, 1e-4);
  EXPECT_NEAR(fit.axis.perspective, truth.perspective, 1e-6);
  EXPECT_TRUE(fit.warnings.empty()) << fit.warnings.front();
}

TEST(AxisFit, TheOrderOfTheStopsDoesNotMatter) {
  std::vector<AxisStop> stops = stopsOf(slantedAxis(), 9, 0.02, 0.02, 2);
  const AxisFit fit = fitAxis(stops);
  std::reverse(stops.begin(), stops.end());
  const AxisFit other = fitAxis(stops);
  EXPECT_LT((fit.axis.origin - other.axis.origin).norm(), 1e-9);
  EXPECT_NEAR(fit.axis.perspective, other.axis.perspective, 1e-9);
}

/// Mean of the squared errors in units of the stated covariance. It follows an F distribution with few degrees of
/// freedom, whose mean for 12 stops is 9 / 7 and 10 / 8.
TEST(AxisFit, TheCovarianceIsThatOfTheErrors) {
  const SlideAxis truth = slantedAxis();
  constexpr int kRuns = 400;
  Eigen::Matrix<double, 5, 1> sum = Eigen::Matrix<double, 5, 1>::Zero();
  for (unsigned seed = 0; seed < kRuns; ++seed) {
    const AxisFit fit = fitAxis(stopsOf(truth, 12, 0.02, 0.05, seed));
    ASSERT_TRUE(fit.perspective_observed);
    const Eigen::Vector2d d = truth.direction, n(-d.y(), d.x()), shift = fit.axis.origin - truth.origin;
    Eigen::Matrix<double, 5, 1> error;
    error << shift.dot(d), shift.dot(n), angleOf(fit.axis) - angleOf(truth),
        fit.axis.pixels_per_metre - truth.pixels_per_metre, fit.axis.perspective - truth.perspective;
    sum += error.cwiseAbs2().cwiseQuotient(fit.axis.covariance.diagonal());
  }
  for (int i = 0; i < 5; ++i) {
    EXPECT_GT(sum(i) / kRuns, 0.95) << i;
    EXPECT_LT(sum(i) / kRuns, 1.75) << i;
  }
}

TEST(AxisFit, AWrongSlideIsLeftOutAndNamed) {
  const SlideAxis truth = slantedAxis();
  std::vector<AxisStop> stops = stopsOf(truth, 10, 0.03, 0.03, 5);
  stops[3].slide += 1e-3;
  const AxisFit fit = fitAxis(stops);
  EXPECT_TRUE(fit.stops[3].left_out);
  EXPECT_NEAR(fit.axis.pixels_per_metre, truth.pixels_per_metre, 10);
  ASSERT_FALSE(fit.warnings.empty());
  EXPECT_NE(fit.warnings[0].find("stop 3 deviates by -0.99"), std::string::npos) << fit.warnings[0];
  stops[3].slide -= 1e-3;  // control: without the mistake all are used
  for (const StopResidual& stop : fitAxis(stops).stops) EXPECT_FALSE(stop.left_out);
}

TEST(AxisFit, GoodStopsAreRarelyLeftOut) {
  int left_out = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    for (const StopResidual& stop : fitAxis(stopsOf(slantedAxis(), 10, 0.05, 0.05, seed)).stops)
      left_out += stop.left_out ? 1 : 0;
  }
  EXPECT_LE(left_out, 15);  // 3 expected
}

TEST(AxisFit, APerspectiveThatTheStopsDoNotShowIsZeroAndSaid) {
  SlideAxis truth = slantedAxis();
  truth.perspective = 0.02;  // 0.05 px at the end
  const AxisFit fit = fitAxis(stopsOf(truth, 7, 0.5, 0.1, 3));
  EXPECT_FALSE(fit.perspective_observed);
  EXPECT_EQ(fit.axis.perspective, 0);
  EXPECT_EQ(fit.axis.covariance(4, 4), 0);
  ASSERT_FALSE(fit.warnings.empty());
  EXPECT_NE(fit.warnings[0].find("the perspective is not observable"), std::string::npos);
}

TEST(AxisFit, ResidualsArePixelsAndMetres) {
  const AxisFit fit = fitAxis(stopsOf(slantedAxis(), 200, 0.1, 0.2, 4));
  EXPECT_NEAR(fit.rms_along, 0.1, 0.015);
  EXPECT_NEAR(fit.rms_across, 0.2, 0.03);
  EXPECT_NEAR(fit.axis.residual_rms, 0.1 / 10300, 0.15e-5);
}

TEST(AxisFit, WhatCannotBeFittedIsSaid) {
  const std::vector<AxisStop> stops = stopsOf(slantedAxis(), 6, 0, 0, 1);
  const std::vector<AxisStop> four(stops.begin(), stops.begin() + 4);
  EXPECT_ERROR(fitAxis(four), "stood at 4 different slides, 5 are needed");
  std::vector<AxisStop> same(10, stops.front());
  EXPECT_ERROR(fitAxis(same), "stood at 1 different slides");
  std::vector<AxisStop> still = stops;
  for (AxisStop& stop : still) stop.pixel = {100, 100};
  EXPECT_ERROR(fitAxis(still), "moved by 0.0 px only");
  std::vector<AxisStop> broken = stops;
  broken[2].pixel.x() = std::nan("");
  EXPECT_ERROR(fitAxis(broken), "stop 2: has no finite position");
}

std::vector<MotionSample> motionOf(const SlideAxis& axis, std::size_t count, double error, unsigned seed) {
  std::vector<MotionSample> samples;
  for (const AxisStop& stop : stopsOf(axis, count, error, error, seed))
    samples.push_back({stop.pixel, pixelsPerMetre(axis, stop.slide)});
  return samples;
}

TEST(MotionFit, LineAndScaleComeFromTheMarker) {
  SlideAxis truth = slantedAxis();
  truth.perspective = 0;
  std::vector<MotionSample> samples = motionOf(truth, 50, 0.02, 1);
  samples[20].pixel += Eigen::Vector2d(3, 40);  // something else
  const MotionFit fit = fitMotion(samples, {0.004, 0}, Eigen::Vector2d::Zero());
  EXPECT_NEAR(angleOf(fit.axis), angleOf(truth), 2e-4);
  const Eigen::Vector2d first = truth.origin + truth.direction * alongOf(truth, -5e-3);
  EXPECT_LT((fit.axis.origin - first).norm(), 0.08);
  EXPECT_NEAR(fit.axis.pixels_per_metre, truth.pixels_per_metre, 1);
  EXPECT_NEAR(fit.scale_uncertainty, 0.004, 1e-6);
  EXPECT_NEAR(std::sqrt(fit.axis.covariance(3, 3)), 0.004 * 10300, 0.5);
  EXPECT_TRUE(fit.warnings.empty());
}

TEST(MotionFit, ASleeveSaysWherePositiveSlideIs) {
  SlideAxis truth = slantedAxis();
  truth.perspective = 0;
  const std::vector<MotionSample> samples = motionOf(truth, 50, 0.02, 1);
  const MotionFit fit = fitMotion(samples, {}, -truth.direction);
  EXPECT_LT(fit.axis.direction.dot(truth.direction), -0.999);
}

TEST(MotionFit, AMarkerThatGrowsIsSaid) {
  const MotionFit fit = fitMotion(motionOf(slantedAxis(), 50, 0.02, 1), {}, Eigen::Vector2d::Zero());
  ASSERT_EQ(fit.warnings.size(), 1U);
  EXPECT_NE(fit.warnings[0].find("not parallel to the sensor"), std::string::npos);
  EXPECT_GT(fit.scale_uncertainty, 0.01);
}

TEST(MotionFit, WhatCannotBeFittedIsSaid) {
  const std::vector<MotionSample> samples = motionOf(slantedAxis(), 50, 0.02, 1);
  const std::vector<MotionSample> few(samples.begin(), samples.begin() + 4), still(30, samples[0]);
  EXPECT_ERROR(fitMotion(few, {}, {0, 0}), "was found in 4 images");
  EXPECT_ERROR(fitMotion(still, {}, {0, 0}), "move the instrument over its whole range");
}

}  // namespace
}  // namespace vibe::vision::axis_fit_test
