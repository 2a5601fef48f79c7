#include "geometry/remesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "geometry/mesh_quality.hpp"
#include "geometry/surface_check.hpp"
#include "geometry/test_surfaces.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::remesh_test {
namespace {

using test::makeBox;
using test::makeUvSphere;

constexpr double kDegree = M_PI / 180;

void expectEven(const SurfaceMesh& mesh, const char* name) {
  EXPECT_NO_THROW(checkSurface(mesh, name));
  const test::MeshQuality quality = test::measureQuality(mesh);
  EXPECT_GE(quality.smallest_valence, 4) << name;
  EXPECT_LE(quality.largest_valence, 9) << name;
  EXPECT_GT(quality.smallest_angle, 25 * kDegree) << name;
  EXPECT_LT(quality.edge_variation, 0.2) << name;
}

class RemeshCount : public testing::TestWithParam<int> {};

TEST_P(RemeshCount, isMetExactlyOnASphere) {
  const SurfaceMesh input = makeUvSphere(0.05, 30, 60);
  RemeshReport report;
  const SurfaceMesh mesh = remeshSurface(input, GetParam(), &report);
  EXPECT_EQ(static_cast<int>(mesh.vertices.size()), GetParam());
  EXPECT_EQ(static_cast<int>(mesh.triangles.size()), 2 * GetParam() - 4);  // closed, genus 0
  expectEven(mesh, "sphere");
  EXPECT_LT(std::abs(report.volume_error), 0.005);
  EXPECT_LT(report.mean_distance, GetParam() < 200 ? 2e-3 : 3e-4);
}

INSTANTIATE_TEST_SUITE_P(Numbers, RemeshCount, testing::Values(100, 101, 642, 1000, 3618, 15000));

TEST(Remesh, boxWithSharpEdgesBecomesEven) {
  const SurfaceMesh input = makeBox(0.1, 0.07, 0.05);
  RemeshReport report;
  const SurfaceMesh mesh = remeshSurface(input, 2000, &report);
  EXPECT_EQ(mesh.vertices.size(), 2000u);
  expectEven(mesh, "box");
  EXPECT_LT(report.mean_distance, 1e-3);
  EXPECT_LT(std::abs(report.volume_error), 0.005);
  EXPECT_TRUE(report.smoothed);
}

TEST(Remesh, veryUnevenInputBecomesEven) {
  // needles at the poles, edges from 1 to 60 mm
  SurfaceMesh input = makeUvSphere(0.05, 4, 200);
  for (auto& v : input.vertices) v.z() *= 1.5;
  EXPECT_GT(test::measureQuality(input).edge_variation, 0.6);  // else the test says nothing
  RemeshReport report;
  const SurfaceMesh mesh = remeshSurface(input, 1500, &report);
  expectEven(mesh, "uneven");
  EXPECT_LT(std::abs(report.volume_error), 0.005);
  EXPECT_LT(report.mean_distance, 2e-3);
}

TEST(Remesh, smoothsTheCreasesOfCoarseInput) {
  const SurfaceMesh input = makeUvSphere(0.05, 8, 12);
  RemeshReport report;
  const test::MeshQuality fine = test::measureQuality(remeshSurface(input, 4000, &report));
  EXPECT_TRUE(report.smoothed);
  EXPECT_GT(test::measureQuality(input).largest_bend, 25 * kDegree);
  EXPECT_LT(fine.largest_bend, 15 * kDegree);
}

TEST(Remesh, doesNotSmoothFineInput) {
  RemeshReport report;
  remeshSurface(makeUvSphere(0.05, 80, 160), 1000, &report);
  EXPECT_FALSE(report.smoothed);
}

TEST(Remesh, givesTheSameBitsTwice) {
  const SurfaceMesh input = makeUvSphere(0.05, 8, 12);
  const SurfaceMesh first = remeshSurface(input, 777), second = remeshSurface(input, 777);
  EXPECT_EQ(first.triangles, second.triangles);
  EXPECT_TRUE(std::equal(first.vertices.begin(), first.vertices.end(), second.vertices.begin(),
                         [](const auto& a, const auto& b) { return (a.array() == b.array()).all(); }));
}

TEST(Remesh, reportsProgressUpToTheEnd) {
  double last = -1;
  remeshSurface(makeBox(0.1, 0.1, 0.1), 200, nullptr, [&](const std::string& what, double fraction) {
    EXPECT_FALSE(what.empty());
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1.0);
    last = fraction;
  });
  EXPECT_EQ(last, 1.0);
}

TEST(Remesh, refusesTooFewVertices) {
  EXPECT_THROW(remeshSurface(makeBox(0.1, 0.1, 0.1), 5), Error);
}

}  // namespace
}  // namespace vibe::remesh_test
