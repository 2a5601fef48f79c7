#include "vibe_core/suture/suture_thread.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "suture/thread_reference.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::catenary_test {
namespace {

using Eigen::Vector3d;
const Vector3d kDown(0, -1, 0);

/// The worst of: the end is missed, a step of arc length is longer than itself, gravity and tension do not balance.
/// All as shares of the length (of its weight, for forces).
double worstError(const Catenary& thread, int pieces = 400) {
  const double scale = thread.length;
  double worst = (thread.point(0) - thread.first).norm() / scale;
  worst = std::max(worst, (thread.point(thread.length) - thread.last).norm() / scale);
  Vector3d before = thread.first;
  for (int i = 1; i <= pieces; ++i) {
    const double s = thread.length * i / pieces;
    const Vector3d here = thread.point(s);
    worst = std::max(worst, ((here - before).norm() - thread.length / pieces) / scale);
    before = here;
    if (thread.weight == 0 || thread.taut) continue;
    // dT/ds is the weight's share along the thread: T(s) - T(0) is the weight times the height (exact).
    const double rise = (here - thread.first).dot(thread.up);
    const double error = thread.tension(s) - thread.tension(0) - thread.weight * rise;
    worst = std::max(worst, std::abs(error) / (thread.weight * scale + thread.tension(s)));
  }
  return worst;
}

double polylineLength(const Catenary& thread, int pieces = 20000) {
  double sum = 0;
  Vector3d before = thread.point(0);
  for (int i = 1; i <= pieces; ++i) {
    const Vector3d here = thread.point(thread.length * i / pieces);
    sum += (here - before).norm();
    before = here;
  }
  return sum;
}

void expectReference(const std::string& name, double drop) {
  const Catenary thread = hang({0, 0, 0}, {0.2, -drop, 0}, 0.3, 0.02, kDown);
  const auto value = [&](const char* quantity) { return test::referenceValue(name, quantity); };
  EXPECT_NEAR(thread.scale / value("a_m"), 1, 1e-7);
  EXPECT_NEAR(thread.horizontalTension() / value("horizontal_tension_N"), 1, 1e-7);
  EXPECT_NEAR(thread.firstTension() / value("tension_A_N"), 1, 1e-7);
  EXPECT_NEAR(thread.lastTension() / value("tension_B_N"), 1, 1e-7);
  EXPECT_NEAR(thread.lowestPoint().x() / value("lowest_x_m"), 1, 1e-7);
  EXPECT_NEAR(thread.lowestPoint().y() / value("lowest_y_m"), 1, 1e-7);
  const auto shape = test::referenceShape(name);
  ASSERT_EQ(shape.size(), 21u);
  for (const auto& row : shape) {
    EXPECT_NEAR((thread.point(row.arc_length) - Vector3d(row.x, row.y, 0)).norm(), 0, 1e-8);
    EXPECT_NEAR(thread.tension(row.arc_length) / row.tension, 1, 1e-7);
  }
}

TEST(Catenary, IsTheReferenceBetweenLevelEnds) {
  expectReference("9a_level", 0);
}

TEST(Catenary, IsTheReferenceBetweenUnevenEnds) {
  expectReference("9b_uneven", 0.05);
}

TEST(Catenary, TheReferenceTellsThreadsApart) {
  // Negative control: a thread 0.1 % longer is not the reference.
  const Catenary thread = hang({0, 0, 0}, {0.2, 0, 0}, 0.3003, 0.02, kDown);
  EXPECT_GT(std::abs(thread.lowestPoint().y() / test::referenceValue("9a_level", "lowest_y_m") - 1), 1e-3);
}

TEST(Catenary, HoldsItsEndsLengthAndBalanceFromNearlyStraightToNearlyVertical) {
  for (const double level : {1.0, 0.3, 1e-2, 1e-5, 1e-9, 1e-13, 1e-20, 0.0})
    for (const double rise : {0.0, 1e-9, 0.2, -0.5, 1.0, -1.0})
      for (const double spare : {1e-14, 1e-12, 1e-9, 1e-5, 0.01, 0.5, 10.0, 1e6}) {
        const Vector3d last(level, rise, 0);
        const double length = std::max(last.norm(), 1e-3) * (1 + spare);
        const Catenary thread = hang({0, 0, 0}, last, length, 0.02, kDown);
        ASSERT_FALSE(thread.taut);
        // The spare length is a difference: its rounding over the sag, sqrt(spare), is what the arguments say.
        EXPECT_LT(worstError(thread), 1e-13 + 1e-16 / std::sqrt(spare)) << level << ' ' << rise << ' ' << spare;
        EXPECT_TRUE(std::isfinite(thread.firstTension()) && std::isfinite(thread.horizontalTension()));
      }
}

TEST(Catenary, ArcLengthIsLength) {
  for (const double length : {0.2001, 0.25, 0.6, 3.0})
    EXPECT_NEAR(polylineLength(hang({0, 0, 0}, {0.2, -0.05, 0.01}, length + 0.01, 1, {0.1, -1, 0.3})) / (length + 0.01),
                1, 1e-6);
}

TEST(Catenary, VerticalStrandsCarryWhatHangsBelowThem) {
  const Catenary thread = hang({0, 0.3, 0}, {0, 0.2, 0}, 0.5, 0.02, kDown);
  EXPECT_NEAR(thread.firstTension(), 0.02 * 0.3, 1e-12);
  EXPECT_NEAR(thread.lastTension(), 0.02 * 0.2, 1e-12);
  EXPECT_NEAR(thread.lowestPoint().y(), 0.0, 1e-12);
  EXPECT_EQ(thread.horizontalTension(), 0);
}

TEST(Catenary, CoincidentEndsMakeALoopOfTwoStrands) {
  const Catenary thread = hang({1, 2, 3}, {1, 2, 3}, 0.4, 0.02, {0, 0, -9.81});
  EXPECT_NEAR((thread.lowestPoint() - Vector3d(1, 2, 2.8)).norm(), 0, 1e-12);
  EXPECT_NEAR((thread.point(0.4) - Vector3d(1, 2, 3)).norm(), 0, 1e-12);
}

TEST(Catenary, NearlyStraightPullsAsTheParabola) {
  // H = w h^2 / (8 sag), sag^2 = 3/8 h (L - h): exact in the limit.
  const double spare = 1e-10;
  const Catenary thread = hang({0, 0, 0}, {1, 0, 0}, 1 + spare, 0.02, kDown);
  EXPECT_NEAR(thread.horizontalTension() / (0.02 / std::sqrt(24 * spare)), 1, 1e-6);
}

TEST(Catenary, TautIsStraightAndHasNoTensionOfItsOwn) {
  for (const double length : {0.0, 0.1, 0.2}) {
    const Catenary thread = hang({0, 0, 0}, {0.2, 0, 0}, length, 0.02, kDown);
    EXPECT_TRUE(thread.taut);
    EXPECT_EQ(thread.firstTension(), 0);
    EXPECT_TRUE(thread.point(0.5 * length).isApprox(Vector3d(length > 0 ? 0.1 : 0, 0, 0)));
    EXPECT_TRUE(thread.lowestPoint().allFinite());
  }
}

TEST(Catenary, WithoutWeightKeepsItsShapeAndPullsNothing) {
  const Catenary heavy = hang({0, 0, 0}, {0.2, 0.1, 0}, 0.3, 0.02, kDown);
  const Catenary weightless = hang({0, 0, 0}, {0.2, 0.1, 0}, 0.3, 0, kDown);
  EXPECT_EQ(weightless.firstTension(), 0);
  EXPECT_TRUE(weightless.point(0.1).isApprox(heavy.point(0.1)));
}

TEST(Catenary, WithoutGravitySagsSquareToItsEnds) {
  const Catenary thread = hang({0, 0, 0}, {0.2, 0.1, 0}, 0.3, 0.02, {0, 0, 0});
  EXPECT_EQ(thread.firstTension(), 0);
  EXPECT_NEAR(thread.up.dot(Vector3d(0.2, 0.1, 0)), 0, 1e-15);
  EXPECT_LT(worstError(thread), 1e-12);
}

TEST(Catenary, SeesOnlyWhereItsEndsAreRelativeToGravity) {
  // Turned, moved and hung the other way round it is the same thread.
  const Eigen::AngleAxisd turn(1.1, Vector3d(1, 2, -0.5).normalized());
  const Vector3d a(0.1, 0.2, -0.1), b(0.3, 0.1, 0.05), move(3, -2, 1), down(0, 0, -9.81);
  const Catenary one = hang(a, b, 0.4, 0.02, down);
  const Catenary turned = hang(turn * a + move, turn * b + move, 0.4, 0.02, turn * down);
  const Catenary reversed = hang(b, a, 0.4, 0.02, 7 * down);
  for (const double s : {0.0, 0.05, 0.2, 0.33, 0.4}) {
    EXPECT_LT((turn * one.point(s) + move - turned.point(s)).norm(), 1e-14);
    EXPECT_LT((one.point(s) - reversed.point(0.4 - s)).norm(), 1e-14);
    EXPECT_NEAR(one.tension(s), reversed.tension(0.4 - s), 1e-16);
  }
}

TEST(Catenary, ScalesWithLength) {
  const Catenary one = hang({0, 0, 0}, {0.2, -0.05, 0}, 0.3, 0.02, kDown);
  for (const double scale : {1e-150, 1e-6, 1e6, 1e150}) {
    const Catenary other = hang({0, 0, 0}, Vector3d(0.2, -0.05, 0) * scale, 0.3 * scale, 0.02, kDown);
    EXPECT_NEAR((other.point(0.1 * scale) / scale - one.point(0.1)).norm(), 0, 1e-14);
    EXPECT_NEAR(other.firstTension() / scale / one.firstTension(), 1, 1e-13);
  }
}

TEST(Catenary, RefusesWhatIsNoThread) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const Vector3d a(0, 0, 0), b(0.2, 0, 0);
  EXPECT_THROW(hang({nan, 0, 0}, b, 0.3, 0.02, kDown), Error);
  EXPECT_THROW(hang(a, {0, infinity, 0}, 0.3, 0.02, kDown), Error);
  EXPECT_THROW(hang(a, b, nan, 0.02, kDown), Error);
  EXPECT_THROW(hang(a, b, -0.1, 0.02, kDown), Error);
  EXPECT_THROW(hang(a, b, 0.3, -1, kDown), Error);
  EXPECT_THROW(hang(a, b, 0.3, 0.02, {0, nan, 0}), Error);
}

}  // namespace
}  // namespace vibe::catenary_test
