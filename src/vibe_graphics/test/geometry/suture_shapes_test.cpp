#include "vibe_graphics/geometry/suture_shapes.hpp"

#include <gtest/gtest.h>

#include <set>

#include "geometry/suture_ends.hpp"
#include "shape_measures.hpp"

namespace vibe::graphics::suture_shapes_test {
namespace {

using Eigen::Vector3d;

/// Three bites in the plane z = 0 on a wall that looks along z: a taut piece along x, then a slack one along y.
SutureSet corner() {
  SutureSet set;
  for (const Vector3d& place : {Vector3d(0, 0, 0), Vector3d(0.02, 0, 0), Vector3d(0.02, 0.02, 0)})
    set.bites.push_back({place, true, Vector3d::UnitZ()});
  set.pieces = {{{set.bites[0].place, set.bites[1].place}, 1.5},
                {{set.bites[1].place, {0.02, 0.01, -0.003}, set.bites[2].place}, 0}};
  return set;
}

SutureDrawing sceneOf(const SutureSet& set) {
  SutureDrawing scene;
  scene.sets.push_back(set);
  return scene;
}

SutureStyle threadOnly() {
  SutureStyle style;
  style.bites = style.ends = style.corners = style.links = false;
  style.tension_map = ColourMap("viridis", 0, 4);
  return style;
}

ColouredShape shapeOf(const SutureSet& set, const SutureStyle& style) {
  ColouredShape shape;
  appendSutures(sceneOf(set), style, shape);
  EXPECT_TRUE(isSound(shape));
  return shape;
}

std::set<PackedColour> coloursOf(const ColouredShape& shape) {
  return {shape.colours.begin(), shape.colours.end()};
}

TEST(SutureShapes, ThreadHasItsTrueDiameter) {
  SutureSet set = corner();
  set.pieces.resize(1);
  SutureStyle style = threadOnly();
  EXPECT_GE(2 * style.threadRadius(), 0.300e-3);  // USP <861>, size 2-0
  EXPECT_LE(2 * style.threadRadius(), 0.339e-3);
  for (const double emphasis : {1.0, 5.0}) {
    style.emphasis = emphasis;
    const ColouredShape shape = shapeOf(set, style);
    for (std::size_t v = 0; v < shape.vertices.size(); ++v)
      EXPECT_NEAR(distanceToLine(placeOf(shape, v), set.pieces[0].line), 0.16e-3 * emphasis, 1e-8);
  }
}

TEST(SutureShapes, ColourShowsTension) {
  SutureSet set = corner();
  const SutureStyle style = threadOnly();
  const auto colours = coloursOf(shapeOf(set, style));
  EXPECT_EQ(colours.count(style.tension_map.at(1.5)), 1u);
  EXPECT_EQ(colours.count(style.slack_colour), 1u);
  set.pieces[0].tension = 3;
  EXPECT_EQ(coloursOf(shapeOf(set, style)).count(style.tension_map.at(1.5)), 0u);
}

TEST(SutureShapes, SlackThreadHasBandsAndTautThreadHasNone) {
  SutureSet set = corner();
  for (const ThreadColour colouring : {ThreadColour::Tension, ThreadColour::One, ThreadColour::PerSuture}) {
    SutureStyle style = threadOnly();
    style.colouring = colouring;
    const ColouredShape both = shapeOf(set, style);
    SutureSet slack = set, tense = set;
    slack.pieces.erase(slack.pieces.begin());
    tense.pieces.pop_back();
    EXPECT_EQ(coloursOf(shapeOf(slack, style)).size(), 2u);
    EXPECT_EQ(coloursOf(shapeOf(tense, style)).size(), 1u);
  }
}

/// Bands lie end to end on the thread and leave nothing out.
TEST(SutureShapes, BandsCoverTheSlackThread) {
  SutureSet set = corner();
  set.pieces.erase(set.pieces.begin());
  const ColouredShape shape = shapeOf(set, threadOnly());
  const auto& line = set.pieces[0].line;
  for (std::size_t v = 0; v < shape.vertices.size(); ++v) EXPECT_LT(distanceToLine(placeOf(shape, v), line), 0.1605e-3);
  for (int k = 0; k <= 40; ++k) {
    const Vector3d on = k < 20 ? Vector3d(line[0] + k / 20.0 * (line[1] - line[0]))
                               : Vector3d(line[1] + (k - 20) / 20.0 * (line[2] - line[1]));
    double min = 1;
    for (std::size_t t = 0; t < shape.triangles.size(); t += 3)
      for (std::size_t e = 0; e < 3; ++e)
        min = std::min(min, distanceToSegment(on, placeOf(shape, shape.triangles[t + e]),
                                              placeOf(shape, shape.triangles[t + (e + 1) % 3])));
    EXPECT_LT(min, 0.17e-3) << "at " << k;
  }
}

TEST(SutureShapes, EverySutureHasItsColour) {
  std::set<PackedColour> seen;
  for (std::size_t k = 0; k < 12; ++k) seen.insert(sutureColour(k));
  EXPECT_EQ(seen.size(), 12u);
  SutureDrawing scene = sceneOf(corner());
  scene.sets.push_back(corner());
  SutureStyle style = threadOnly();
  style.colouring = ThreadColour::PerSuture;
  ColouredShape shape;
  appendSutures(scene, style, shape);
  EXPECT_EQ(coloursOf(shape).count(sutureColour(0)), 1u);
  EXPECT_EQ(coloursOf(shape).count(sutureColour(1)), 1u);
}

TEST(SutureShapes, FullAndPartialBitesDifferInShapeAndColour) {
  SutureSet full = corner();
  full.pieces.clear();
  SutureSet partial = full;
  for (SutureBite& bite : partial.bites) bite.full_thickness = false;
  SutureStyle style = threadOnly();
  style.bites = true;
  const ColouredShape rings = shapeOf(full, style), balls = shapeOf(partial, style);
  EXPECT_NE(coloursOf(rings), coloursOf(balls));
  const auto nearest = [](const ColouredShape& shape) {
    double min = 1;
    for (std::size_t v = 0; v < shape.vertices.size(); ++v) min = std::min(min, placeOf(shape, v).norm());
    return min;
  };
  EXPECT_GT(nearest(rings), nearest(balls));  // a ring is open in its middle
}

TEST(SutureShapes, PartsAreDrawnOnlyIfSelected) {
  SutureSet set = corner();
  set.has_t_tag = set.has_cinch = true;
  set.t_tag = set.bites[2].place, set.cinch = set.bites[0].place;
  set.corners = {1};
  const std::size_t thread = shapeOf(set, threadOnly()).vertices.size();
  for (bool SutureStyle::*part : {&SutureStyle::bites, &SutureStyle::ends, &SutureStyle::corners}) {
    SutureStyle style = threadOnly();
    style.*part = true;
    EXPECT_GT(shapeOf(set, style).vertices.size(), thread);
  }
}

/// Half of the extent of a shape along a direction, about a point.
double reachOf(const ColouredShape& shape, const Vector3d& centre, const Vector3d& direction) {
  double reach = 0;
  for (std::size_t v = 0; v < shape.vertices.size(); ++v)
    reach = std::max(reach, std::abs((placeOf(shape, v) - centre).dot(direction)));
  return reach;
}

TEST(SutureShapes, TagAndCinchHaveTheirSizesAndLieOnTheWall) {
  SutureSet set = corner();
  set.bites.pop_back(), set.pieces.pop_back();  // along x, on the wall z = 0
  set.t_tag = set.bites[1].place, set.cinch = set.bites[0].place;
  ColouredShape tag, cinch;
  appendTag(set, 1, {packed(0, 0, 1), 0.16e-3}, tag);
  appendCinch(set, 1, {packed(0, 0, 1), 0.16e-3}, cinch);
  ASSERT_TRUE(isSound(tag) && isSound(cinch));
  EXPECT_NEAR(reachOf(tag, set.t_tag, Vector3d::UnitY()), 3.25e-3, 1e-6);    // across the thread
  EXPECT_NEAR(reachOf(tag, set.t_tag, Vector3d::UnitX()), 0.55e-3, 0.1e-3);  // with its winding
  EXPECT_NEAR(reachOf(cinch, set.cinch, Vector3d::UnitY()), 1.3e-3, 1e-5);   // the collar
  double highest[2] = {0, 0}, farthest_out = 0;
  for (std::size_t v = 0; v < tag.vertices.size(); ++v) highest[0] = std::max(highest[0], placeOf(tag, v).z());
  for (std::size_t v = 0; v < cinch.vertices.size(); ++v) {
    highest[1] = std::max(highest[1], placeOf(cinch, v).z());
    farthest_out = std::max(farthest_out, -placeOf(cinch, v).x());
  }
  EXPECT_GT(highest[0], 0.7e-3);  // most of them is in the lumen
  EXPECT_GT(highest[1], 1.7e-3);
  EXPECT_GT(farthest_out, 4e-3);  // the cut end of the thread
  EXPECT_GT(coloursOf(tag).size(), 1u);
}

TEST(SutureShapes, NaturalThreadHasOneColour) {
  SutureSet set = corner();
  set.pieces.erase(set.pieces.begin());
  EXPECT_EQ(coloursOf(shapeOf(set, naturalSutures())).size(), 1u);
  EXPECT_EQ(coloursOf(shapeOf(set, threadOnly())).size(), 2u);  // control: data have bands where it is slack
}

TEST(SutureShapes, LinksJoinTheirBites) {
  SutureSet set = corner();
  set.links = {{0, 2}};
  SutureStyle style;
  ColouredShape shape;
  appendLinks(sceneOf(set), style, shape);
  ASSERT_TRUE(isSound(shape));
  ASSERT_FALSE(shape.vertices.empty());
  double first = 1, last = 1;
  for (std::size_t v = 0; v < shape.vertices.size(); ++v) {
    const Vector3d p = placeOf(shape, v);
    EXPECT_LT(distanceToSegment(p, set.bites[0].place, set.bites[2].place), 0.7e-3);
    EXPECT_NEAR(p.z(), 0, 1e-8);  // flat in the plane of the bites
    first = std::min(first, p.norm()), last = std::min(last, (p - set.bites[2].place).norm());
  }
  EXPECT_LT(std::max(first, last), 4e-3);
  shape.clear();
  style.links = false;
  appendLinks(sceneOf(set), style, shape);
  EXPECT_TRUE(shape.vertices.empty());
}

TEST(SutureShapes, CoincidentBitesAreDrawn) {
  SutureSet set = corner();
  for (SutureBite& bite : set.bites) bite.place.setZero(), bite.inward.setZero();
  for (ThreadPiece& piece : set.pieces)
    for (Vector3d& point : piece.line) point.setZero();
  set.has_t_tag = set.has_cinch = true;
  set.t_tag.setZero(), set.cinch.setZero();
  set.links = {{0, 2}};
  set.corners = {1};
  SutureStyle style = threadOnly();
  style.bites = style.ends = style.corners = style.links = true;
  EXPECT_FALSE(shapeOf(set, style).vertices.empty());
  ColouredShape links;
  appendLinks(sceneOf(set), style, links);
  EXPECT_TRUE(isSound(links));
}

TEST(SutureShapes, LabelsShowTechniqueAndFaults) {
  SutureSet set = corner();
  EXPECT_EQ(labelOf(set, 0), "1: 3 bites");
  set.bites.resize(1);
  EXPECT_EQ(labelOf(set, 0), "1: 1 bite");
  set.technique = "u", set.margin = 0.987;
  EXPECT_EQ(labelOf(set, 1), "2: U 0.99");
  set.technique = "running", set.loose = true, set.tear_outs = 2;
  EXPECT_EQ(labelOf(set, 1), "2: running 0.99, loose, 2 torn out");
  set.stage = SutureStage::Broken;
  EXPECT_NE(labelOf(set, 1).find("broken"), std::string::npos);
}

TEST(SutureShapes, LabelsAreInTheLumen) {
  SutureSet set = corner();
  EXPECT_LT((labelPlace(set, 0.01) - Vector3d(0.04 / 3, 0.02 / 3, 0.01)).norm(), 1e-12);
  for (SutureBite& bite : set.bites) bite.inward.setZero();
  EXPECT_NEAR(labelPlace(set, 0.01).z(), 0, 1e-12);
  EXPECT_EQ(labelPlace({}, 0.01), Vector3d::Zero());
}

TEST(SutureFrame, DirectionsRotateWithTheSuture) {
  SutureSet set = corner();
  const Eigen::AngleAxisd turn(0.8, Vector3d(1, 2, 3).normalized());
  SutureSet turned = set;
  for (SutureBite& bite : turned.bites) bite.place = turn * bite.place, bite.inward = turn * bite.inward;
  for (ThreadPiece& piece : turned.pieces)
    for (Vector3d& point : piece.line) point = turn * point;
  EXPECT_NEAR(std::abs((turn * planeNormal(set)).dot(planeNormal(turned))), 1, 1e-12);
  EXPECT_NEAR((turn * biteAxis(set, 1)).dot(biteAxis(turned, 1)), 1, 1e-12);
  EXPECT_NEAR(std::abs((turn * tagAxis(set)).dot(tagAxis(turned))), 1, 1e-12);
  EXPECT_NEAR((turn * cinchAxis(set)).dot(cinchAxis(turned)), 1, 1e-12);
  EXPECT_LT(std::abs(planeNormal(set).dot(planeNormal(turned))), 0.99);  // control: it did turn
}

TEST(SutureFrame, TagLiesAcrossTheThreadOnTheWall) {
  SutureSet set = corner();
  set.pieces.pop_back();
  EXPECT_NEAR(std::abs(planeNormal(set).z()), 1, 1e-12);
  EXPECT_NEAR(tagAxis(set).dot(Vector3d::UnitX()), 0, 1e-12);
  EXPECT_NEAR(tagAxis(set).z(), 0, 1e-12);
  EXPECT_NEAR(cinchAxis(set).x(), 1, 1e-12);
}

TEST(SutureFrame, RingLiesOnTheWallOrAroundTheThread) {
  SutureSet set = corner();
  EXPECT_EQ(biteAxis(set, 0), Vector3d::UnitZ());
  for (SutureBite& bite : set.bites) bite.inward.setZero();
  EXPECT_NEAR(biteAxis(set, 0).x(), 1, 1e-12);
}

TEST(SutureFrame, DirectionsAreDefinedForAnEmptySuture) {
  const SutureSet none;
  for (const Vector3d& axis : {planeNormal(none), biteAxis(none, 0), tagAxis(none), cinchAxis(none)})
    EXPECT_NEAR(axis.norm(), 1, 1e-12);
}

}  // namespace
}  // namespace vibe::graphics::suture_shapes_test
