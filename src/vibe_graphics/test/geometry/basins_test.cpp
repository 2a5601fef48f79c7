#include "vibe_graphics/geometry/basins.hpp"

#include <gtest/gtest.h>

#include "walls.hpp"

namespace vibe::graphics::basins_test {
namespace {

using Eigen::Vector3d;

const Vector3d kDown = -Vector3d::UnitZ();
constexpr std::uint32_t kRows = 121;  // of triangles with a side of 0.6 mm

std::uint32_t vertexAt(double x, double y) {
  const auto index = [](double p) {
    return static_cast<std::uint32_t>(std::lround((p / 0.036 + 1) / 2 * (kRows - 1)));
  };
  return index(y) * kRows + index(x);
}

/// Two hollows along x, the left one 2 mm deep, the right one 4 mm, with a brim at height 0 between them and walls
/// around.
double twoHollows(double x, double y) {
  const double deep = x < 0 ? 0.002 : 0.004;
  const double t = std::abs(x) - 0.017;
  return -deep * std::max(0.0, 1 - t * t / (0.017 * 0.017)) + 4 * y * y + (std::abs(x) > 0.034 ? 0.05 : 0);
}

TEST(Basins, VolumeOnATriangleIsThatOfItsClippedPrism) {
  EXPECT_DOUBLE_EQ(volumeOnTriangle(2, 3, 3, 3), 6);
  EXPECT_DOUBLE_EQ(volumeOnTriangle(2, -0.5, -1, -1), 0);
  EXPECT_DOUBLE_EQ(volumeOnTriangle(1, 3, 0, 0), 1);
  EXPECT_DOUBLE_EQ(volumeOnTriangle(1, 1, -1, -1), 1.0 / 12);           // a tetrahedron of a quarter of the area
  EXPECT_DOUBLE_EQ(volumeOnTriangle(1, 1, 1, -1), 1.0 / 3 + 1.0 / 12);  // its complement, from the difference of both
  for (double z = -1; z <= 1; z += 0.01) {                              // the derivative is continuous
    const double step = volumeOnTriangle(1, z + 0.31, z + 0.01, z - 0.19) - volumeOnTriangle(1, z + 0.3, z, z - 0.2);
    EXPECT_GE(step, 0);
    EXPECT_LE(step, 0.0101);
  }
}

TEST(Basins, LevelInABowlIsThatOfASphericalCap) {
  const test::HeightWall form(kRows, 0.036, test::bowl);
  const WallSurface wall = form.surface();
  for (const double volume : {2e-8, 2e-7, 2e-6, 1e-5}) {
    Basins basins(wall, kDown);
    basins.pour(vertexAt(0.02, 0.01), volume, 0);
    ASSERT_EQ(basins.pools().size(), 1U);
    const Pool& pool = basins.pools().front();
    const double height = test::capHeight(volume);
    std::printf("%.3g mL: level %.4f mm, cap %.4f mm\n", volume * 1e6, pool.level * 1e3, height * 1e3);
    EXPECT_NEAR(pool.level / height, 1, 0.03);
    EXPECT_EQ(pool.volume, volume);
    EXPECT_GT(std::abs(pool.level / test::capHeight(1.2 * volume) - 1), 0.03);  // control: a fifth more
  }
}

TEST(Basins, TwoSourcesInOneBowlShareAPool) {
  const test::HeightWall form(kRows, 0.036, test::bowl);
  const WallSurface wall = form.surface();
  Basins two(wall, kDown), one(wall, kDown);
  two.pour(vertexAt(0.02, 0.01), 3e-7, 0);
  two.pour(vertexAt(-0.01, 0.02), 5e-7, 1);
  one.pour(vertexAt(0.02, 0.01), 8e-7, 0);
  ASSERT_EQ(two.pools().size(), 1U);
  EXPECT_NEAR(two.pools()[0].level, one.pools()[0].level, 2e-6);
  EXPECT_NEAR(two.pools()[0].volume, 8e-7, 1e-15);
  EXPECT_NEAR(two.pools()[0].brown, 5.0 / 8, 1e-9);
}

TEST(Basins, FullHollowRunsOverAndTwoFullOnesBecomeOne) {
  const test::HeightWall form(kRows, 0.036, twoHollows);
  const WallSurface wall = form.surface();
  const std::uint32_t left = vertexAt(-0.017, 0), right = vertexAt(0.017, 0);
  const auto poured = [&](double volume) {
    Basins basins(wall, kDown);
    basins.pour(left, volume, 0);
    return basins;
  };
  const double small = 1e-7, middling = 1.5e-6, large = 8e-6;
  EXPECT_EQ(poured(small).pools().size(), 1U);
  EXPECT_LT(poured(small).pools()[0].level, -1e-4);
  const Basins over = poured(middling);
  ASSERT_EQ(over.pools().size(), 2U);
  EXPECT_EQ(over.brims().size(), 1U);
  EXPECT_NEAR(over.pools()[0].level, 0, 2e-5);  // to its brim
  EXPECT_LT(over.pools()[1].level, -1e-4);      // the rest
  EXPECT_NEAR(over.pools()[0].volume + over.pools()[1].volume, middling, 1e-15);
  const Basins joined = poured(large);
  ASSERT_EQ(joined.pools().size(), 1U);
  EXPECT_EQ(joined.pools()[0].bottoms.size(), 2U);
  EXPECT_GT(joined.pools()[0].level, 1e-4);
  EXPECT_NEAR(joined.pools()[0].volume, large, 1e-15);
  // the same in two parts, from either side
  Basins parts(wall, kDown);
  parts.pour(right, 0.6 * large, 0);
  parts.pour(left, 0.4 * large, 0);
  ASSERT_EQ(parts.pools().size(), 1U);
  EXPECT_NEAR(parts.pools()[0].level, joined.pools()[0].level, 1e-5);
}

TEST(Basins, LevelRisesWithTheVolume) {
  const test::HeightWall form(kRows, 0.036, test::bowl);
  const WallSurface wall = form.surface();
  double before = 0;
  for (double volume = 1e-9; volume < 2e-5; volume *= 1.7) {
    Basins basins(wall, kDown);
    basins.pour(vertexAt(0.02, 0.01), volume, 0);
    EXPECT_GT(basins.pools()[0].level, before);
    before = basins.pools()[0].level;
  }
}

}  // namespace
}  // namespace vibe::graphics::basins_test
