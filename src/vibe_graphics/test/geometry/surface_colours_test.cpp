#include "vibe_graphics/geometry/surface_colours.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "vibe_graphics/testing/surfaces.hpp"

namespace vibe::graphics::surface_colours_test {
namespace {

TissueFrame frameOf(const TissueMesh& mesh) {
  TissueFrame frame;
  frame.positions = mesh.rest;
  frame.strain.assign(mesh.particle_count, 0.1F);
  frame.grade.assign(mesh.particle_count, 0);
  frame.dose.assign(mesh.particle_count, 0);
  return frame;
}

TEST(SurfaceColours, NaturalTissueIsWhiteAndSentOnce) {
  const TissueMesh mesh = test::ballMesh(10, 12);
  SurfaceColours colours(mesh);
  const TissueFrame frame = frameOf(mesh);
  EXPECT_EQ(colours.update(frame).count(), mesh.vertex_count);
  for (const PackedColour colour : colours.colours()) EXPECT_EQ(colour, 0xffffffffU);
  EXPECT_TRUE(colours.update(frame).empty());
}

TEST(SurfaceColours, MarkChangesAlphaOfItsVertexOnly) {
  const TissueMesh mesh = test::ballMesh(10, 12);
  SurfaceColours colours(mesh);
  TissueFrame frame = frameOf(mesh);
  colours.update(frame);
  frame.grade[50] = 2;
  const VertexSpan sent = colours.update(frame);
  EXPECT_EQ(sent.first, 50U);
  EXPECT_EQ(sent.count(), 1U);
  EXPECT_EQ(colours.colours()[50], 0x55ffffffU);
  EXPECT_EQ(colours.colours()[51], 0xffffffffU);
}

TEST(SurfaceColours, MarkIsInterpolatedOnTheRenderSurface) {
  const TissueMesh mesh = test::subdividedBall(10, 12);
  SurfaceColours colours(mesh);
  TissueFrame frame = frameOf(mesh);
  colours.update(frame);
  frame.grade[50] = 3;
  const VertexSpan sent = colours.update(frame);
  EXPECT_GT(sent.count(), 1U);
  EXPECT_NEAR(static_cast<double>(colours.colours()[50] >> 24), 255.0 / 3, 1);
}

TEST(SurfaceColours, StrainFollowsTheMapAndItsRange) {
  const TissueMesh mesh = test::ballMesh(10, 12);
  SurfaceColours colours(mesh);
  const ColourMap map("magma", 0.1, 0.6);
  colours.choose(Colouring::Strain, map);
  TissueFrame frame = frameOf(mesh);
  frame.strain[3] = 0.25F;
  colours.update(frame);
  EXPECT_EQ(colours.colours()[2], map.at(0.1));
  EXPECT_EQ(colours.colours()[3], map.at(0.25));
  EXPECT_NE(colours.colours()[2], colours.colours()[3]);
}

TEST(SurfaceColours, WhatWasSeenHasTheColourOfIt) {
  const TissueMesh mesh = test::ballMesh(10, 12);
  SurfaceColours colours(mesh);
  colours.choose(Colouring::Seen, ColourMap());
  TissueFrame frame = frameOf(mesh);
  frame.first_seen.assign(mesh.particle_count, std::nanf(""));
  frame.first_seen[3] = 0;
  colours.update(frame);
  EXPECT_EQ(colours.colours()[2], seenColours()[0]);
  EXPECT_EQ(colours.colours()[3], seenColours()[1]);
}

TEST(SurfaceColours, MissingDataIsDrawnAsNaturalTissue) {
  const TissueMesh mesh = test::ballMesh(10, 12);  // without anatomy
  TissueFrame frame;
  frame.positions = mesh.rest;
  for (const Colouring colouring : {Colouring::Region, Colouring::Wall, Colouring::Strain, Colouring::Heat,
                                    Colouring::Thickness, Colouring::Seen}) {
    SurfaceColours colours(mesh);
    colours.choose(colouring, ColourMap());
    colours.update(frame);
    EXPECT_EQ(colours.colours()[7], 0xffffffffU);
  }
}

TEST(SurfaceColours, RegionsHaveDistinctColoursAndUnknownNumbersNone) {
  TissueMesh mesh = test::ballMesh(10, 12);
  mesh.region.assign(mesh.particle_count, 2);
  mesh.region[5] = 3;
  mesh.region[6] = 99;
  SurfaceColours colours(mesh);
  colours.choose(Colouring::Region, ColourMap());
  colours.update(frameOf(mesh));
  EXPECT_EQ(colours.colours()[4], regionColours()[2]);
  EXPECT_EQ(colours.colours()[5], regionColours()[3]);
  EXPECT_EQ(colours.colours()[6], 0xffffffffU);
}

}  // namespace
}  // namespace vibe::graphics::surface_colours_test
