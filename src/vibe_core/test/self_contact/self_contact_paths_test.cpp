#include "self_contact/self_contact.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "self_contact/self_contact_worlds.hpp"

namespace vibe::self_contact_paths_test {
namespace {

using namespace test;

double minGap(const ContactWorld& world, int cells) {
  const int upper = plateSize(cells);
  double min = std::numeric_limits<double>::infinity();
  for (int i = 0; i < upper; ++i) min = std::min(min, world.get(upper + i).z() - world.get(i).z());
  return min;
}

double pressAtRandom(bool limited, double size) {
  const int cells = 8;
  ContactWorld world(plates(cells, cells));
  world.bring(plateSize(cells), 0.8 * kWallThickness, {0, 0});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  double min = std::numeric_limits<double>::infinity();
  for (int step = 0; step < 16; ++step) {
    world.detect(2e-3);
    std::vector<double> move(world.at.size(), 0.0);
    const double together = step % 2 == 0 ? 1.0 : -0.8;
    for (int i = 0; i < static_cast<int>(world.count()); ++i)
      move[4 * i + 2] = size * ((i < plateSize(cells) ? together : -together) + 0.5 * uniform(random));
    if (limited) {
      world.resolvePenetrations(move);
    } else {
      for (std::size_t k = 0; k < move.size(); ++k) world.at[k] += move[k];
    }
    min = std::min(min, minGap(world, cells));
  }
  return min;
}

TEST(SelfContactPaths, LargeMovesPassThroughNothing) {
  for (const double size : {0.3e-3, 3e-3, 30e-3}) {
    EXPECT_GT(pressAtRandom(true, size), 0) << size;
    EXPECT_LT(pressAtRandom(false, size), -0.5 * size) << size;  // the moves would
  }
}

// Two strips that cross on edge: no vertex comes near the other one's triangles before the edges meet.
TEST(SelfContactPaths, EdgesDoNotPassThroughEdges) {
  SurfaceMesh mesh;
  mesh.vertices = {{-0.02, 0, 0.01}, {0.02, 0, 0.01}, {0, 0, 0.05},    // an edge along x with its triangle above
                   {0, -0.02, 0},    {0, 0.02, 0},    {0, 0, -0.04}};  // an edge along y with its triangle below
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  ContactWorld world(mesh);
  world.detect(1e-3);
  std::vector<double> move(world.at.size(), 0.0);
  for (std::size_t i = 0; i < 3; ++i) move[4 * i + 2] = -0.03;
  EXPECT_EQ(world.resolvePenetrations(move), 3U);  // the edge, and the corner above, which does not run into it
  EXPECT_GT(world.get(0).z(), 0);
  EXPECT_LT(world.get(0).z(), 2e-3);
  EXPECT_LT(world.get(2).z(), 0.05 - 5e-3);
  EXPECT_GT(world.get(2).z(), 0.04 - 6e-3);
}

TEST(SelfContactPaths, WhatMeetsNothingIsLeftToTheBit) {
  ContactWorld world(plates(8, 6));
  world.bring(plateSize(8), 0.8 * kWallThickness);
  for (const double size : {0.1e-3, 50e-3}) {  // together, however fast
    world.detect(1e-3);
    const std::vector<double> before = world.at;
    EXPECT_EQ(world.resolvePenetrations(std::vector<double>(world.at.size(), size)), 0U);
    for (std::size_t k = 0; k < before.size(); ++k) ASSERT_EQ(world.at[k], before[k] + (k % 4 == 3 ? 0 : size));
  }
  world.detect(1e-3);
  std::vector<double> apart(world.at.size(), 0.0);
  for (std::size_t i = plateSize(8); i < world.count(); ++i) apart[4 * i + 2] = 5e-3;
  EXPECT_EQ(world.resolvePenetrations(apart), 0U);
}

// A plate folded sharply is folded on and twisted, through itself: triangles near the crease belong to one wall.
std::size_t crossingsOfFold(bool limited) {
  SurfaceMesh mesh;
  addPlate(8, 2.5e-3, 0, true, mesh);
  ContactWorld world(mesh);
  const auto foldTo = [&](double degrees, double twist) {
    std::vector<double> move = world.at;
    for (std::size_t i = 0; i < world.count(); ++i) {
      const Eigen::Vector3d& p = world.rest.vertices[i];
      const double angle = (degrees + twist * p.y()) * M_PI / 180;
      if (p.x() > 0) move[4 * i] = p.x() * std::cos(angle), move[4 * i + 2] = p.x() * std::sin(angle);
    }
    for (std::size_t k = 0; k < move.size(); ++k) move[k] -= world.at[k];
    return move;
  };
  std::vector<double> move = foldTo(150, 0);
  for (std::size_t k = 0; k < move.size(); ++k) world.at[k] += move[k];
  EXPECT_EQ(world.crossings(), 0U);
  world.detect(1e-3);
  move = foldTo(180, 4000);
  const std::vector<double> start = world.at;
  if (limited) {
    EXPECT_GT(world.resolvePenetrations(move), 0U);
  } else {
    for (std::size_t k = 0; k < move.size(); ++k) world.at[k] += move[k];
  }
  std::size_t most = 0;
  for (double part = 0.1; part < 1.05; part += 0.1) most = std::max(most, world.crossings(start, part));
  return most;
}

TEST(SelfContactPaths, NeighboursInASharpFoldDoNotCross) {
  EXPECT_EQ(crossingsOfFold(true), 0U);
  EXPECT_GT(crossingsOfFold(false), 10U);
}

TEST(SelfContactPaths, WhatCrossesAtTheStartCanComeApart) {
  ContactWorld world(plates(8, 6));
  for (std::size_t i = plateSize(8); i < world.count(); ++i) {
    const Eigen::Vector3d& p = world.rest.vertices[i];
    world.set(i, {p.x() + 0.4e-3, p.y() + 0.7e-3, 0.3 * p.x()});
  }
  ASSERT_GT(world.crossings(), 5U);
  for (int step = 0; step < 12; ++step) {
    world.detect(1e-3);
    std::vector<double> move(world.at.size(), 0.0);
    for (std::size_t i = plateSize(8); i < world.count(); ++i) move[4 * i + 2] = 0.5e-3;
    world.resolvePenetrations(move);
  }
  EXPECT_EQ(world.crossings(), 0U);
}

// A sphere is thrown about node by node; every node may go anywhere within 3 mm, or 20 mm, in a step.
TEST(SelfContactPaths, NothingCrossesAtAnyTimeOfRandomMoves) {
  for (const double size : {3e-3, 20e-3}) {
    ContactWorld world(sphere(0.03, 8)), control(sphere(0.03, 8));
    std::mt19937 random(11);
    std::normal_distribution<double> normal(0, size);
    std::size_t without = 0;
    for (int step = 0; step < 12; ++step) {
      world.detect(1e-3);
      std::vector<double> move(world.at.size(), 0.0);
      for (std::size_t k = 0; k < move.size(); ++k)
        if (k % 4 != 3) move[k] = normal(random) - 0.1 * world.at[k];
      const std::vector<double> before = world.at;
      for (std::size_t k = 0; k < move.size(); ++k) control.at[k] += move[k];
      without += control.crossings();
      EXPECT_GT(world.resolvePenetrations(move), 0U);
      for (const double part : {0.25, 0.5, 0.75, 1.0})
        EXPECT_EQ(world.crossings(before, part), 0U) << size << ' ' << step;
    }
    EXPECT_GT(without, 100U);
  }
}

}  // namespace
}  // namespace vibe::self_contact_paths_test
