#include "method/tet_wall.hpp"

#include <gtest/gtest.h>

#include "tissue/tetrahedra.hpp"

namespace vibe::benchmarks::tet_wall_test {
namespace {

constexpr double kStep = 1e-5;  // [m]

std::vector<double> positions4(const BenchWall& wall) {
  std::vector<double> positions;
  for (const auto& p : wall.body.rest)
    for (const double value : {p.x(), p.y(), p.z(), 0.0}) positions.push_back(value);
  return positions;
}

TEST(TetWall, fillsTheWallWithoutGapsAndOverlaps) {
  const BenchWall shell = makeWall(3618), tets = makeTetWall(shell);
  const auto& elements = dynamic_cast<const TetElements<4>&>(*tets.body.elements);
  // the volume is between the two layers
  SurfaceMesh inner = shell.mesh, outer = shell.mesh;
  for (std::size_t n = 0; n < inner.vertices.size(); ++n) {
    inner.vertices[n] = tets.body.rest[n];
    outer.vertices[n] = tets.body.rest[n + inner.vertices.size()];
  }
  EXPECT_NEAR(elements.volume() / (enclosedVolume(outer) - enclosedVolume(inner)), 1, 1e-3);
  EXPECT_NEAR(elements.volume() / (surfaceArea(shell.mesh) * kWallThickness), 1,
              0.005);  // vertex normals deviate with the curvature
  EXPECT_EQ(tets.tool.size(), 2 * shell.tool.size());
}

TEST(TetWall, pushesWithTheSlopeOfItsPressureEnergy) {
  const BenchWall tets = makeTetWall(makeWall(300));
  tets.layers->setPressure(500);
  std::vector<double> positions = positions4(tets);
  std::vector<float> gradient(positions.size(), 0), ignored(positions.size(), 0);
  EXPECT_NEAR(tets.layers->evaluate(positions.data(), gradient.data()), -500 * tets.rest_volume,
              1e-6 * tets.rest_volume);
  for (const std::size_t i : {4U * 40 + 1, 4U * 170, 4U * (300 + 40) + 1, 4U * (300 + 260) + 2}) {
    const double here = positions[i];
    positions[i] = here + kStep;
    const double above = tets.layers->evaluate(positions.data(), ignored.data());
    positions[i] = here - kStep;
    const double below = tets.layers->evaluate(positions.data(), ignored.data());
    positions[i] = here;
    EXPECT_NEAR(gradient[i], (above - below) / (2 * kStep), 1e-5);
    EXPECT_GT(std::abs(gradient[i]), 1e-4);  // otherwise the test has no significance
  }
}

}  // namespace
}  // namespace vibe::benchmarks::tet_wall_test
