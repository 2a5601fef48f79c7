#include "vibe_graphics/geometry/mesh_index.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

namespace vibe::graphics::triangle_order_test {
namespace {

constexpr std::uint32_t kEdge = 64;  // vertices along the edge of a square grid

std::vector<float> gridPlaces() {
  std::vector<float> places;
  for (std::uint32_t y = 0; y < kEdge; ++y)
    for (std::uint32_t x = 0; x < kEdge; ++x)
      for (const float value : {static_cast<float>(x), static_cast<float>(y), 5.0F}) places.push_back(value);
  return places;
}

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

Triangles shuffledGrid() {
  Triangles triangles;
  for (std::uint32_t y = 0; y + 1 < kEdge; ++y)
    for (std::uint32_t x = 0; x + 1 < kEdge; ++x) {
      const std::uint32_t a = y * kEdge + x;
      triangles.push_back({a, a + 1, a + kEdge}), triangles.push_back({a + 1, a + kEdge + 1, a + kEdge});
    }
  std::shuffle(triangles.begin(), triangles.end(), std::mt19937(3));
  return triangles;
}

std::vector<std::uint32_t> flat(const Triangles& triangles) {
  std::vector<std::uint32_t> list;
  for (const auto& triangle : triangles) list.insert(list.end(), triangle.begin(), triangle.end());
  return list;
}

Triangles listed(const std::vector<std::uint32_t>& flat) {
  Triangles triangles;
  for (std::size_t k = 0; k < flat.size(); k += 3) triangles.push_back({flat[k], flat[k + 1], flat[k + 2]});
  return triangles;
}

/// How many corners are not among the last 32 that were computed, per triangle.
double missesPerTriangle(const std::vector<std::uint32_t>& triangles) {
  std::vector<std::uint32_t> last;
  double misses = 0;
  for (const std::uint32_t corner : triangles) {
    if (std::find(last.begin(), last.end(), corner) != last.end()) continue;
    ++misses;
    last.push_back(corner);
    if (last.size() > 32) last.erase(last.begin());
  }
  return 3 * misses / static_cast<double>(triangles.size());
}

TEST(TriangleOrderTest, HasTheSameTrianglesWithTheSameWinding) {
  Triangles before = shuffledGrid(), after = listed(sortedInSpace(flat(before), gridPlaces()));
  EXPECT_FALSE(before == after);  // control
  std::sort(before.begin(), before.end()), std::sort(after.begin(), after.end());
  EXPECT_TRUE(before == after);
}

TEST(TriangleOrderTest, FindsMostCornersAmongTheLast) {
  const std::vector<std::uint32_t> shuffled = flat(shuffledGrid());
  EXPECT_GT(missesPerTriangle(shuffled), 2.9);  // control
  EXPECT_LT(missesPerTriangle(sortedInSpace(shuffled, gridPlaces())), 1.0);
}

TEST(TriangleOrderTest, IsTheSameForPlacesInAnotherUnit) {
  const std::vector<std::uint32_t> shuffled = flat(shuffledGrid());
  std::vector<float> places = gridPlaces();
  const std::vector<std::uint32_t> sorted = sortedInSpace(shuffled, places);
  for (float& value : places) value *= 1 / 1024.0F;
  EXPECT_TRUE(sortedInSpace(shuffled, places) == sorted);
}

TEST(TriangleOrderTest, LeavesTrianglesWithoutPlacesAndNoTriangles) {
  const std::vector<std::uint32_t> triangle{0, 1, 2};
  EXPECT_TRUE(sortedInSpace(triangle, {}) == triangle);
  EXPECT_TRUE(sortedInSpace({}, {0, 0, 0}).empty());
  EXPECT_TRUE(sortedInSpace(triangle, std::vector<float>(9, 1)) == triangle);  // all in one place
}

}  // namespace
}  // namespace vibe::graphics::triangle_order_test
