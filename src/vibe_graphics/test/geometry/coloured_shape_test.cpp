#include "vibe_graphics/geometry/coloured_shape.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vibe::graphics::coloured_shape_test {
namespace {

ColouredShape triangle() {
  ColouredShape shape;
  shape.vertices = {{{0, 0, 0}, {0, 0, 1}}, {{1, 0, 0}, {0, 0, 1}}, {{0, 1, 0}, {0, 0, 1}}};
  shape.colours.assign(3, packed(1, 0, 0));
  shape.triangles = {0, 1, 2};
  return shape;
}

TEST(ColouredShape, SoundAndEmptyShapesHaveNoProblem) {
  EXPECT_EQ(problemOf(triangle()), "");
  EXPECT_EQ(problemOf(ColouredShape()), "");
}

TEST(ColouredShape, EveryDefectIsNamed) {
  ColouredShape shape = triangle();
  shape.colours.pop_back();
  EXPECT_EQ(problemOf(shape), "The shape has 3 vertices and 2 colours.");
  shape = triangle();
  shape.triangles.pop_back();
  EXPECT_EQ(problemOf(shape), "The shape has an incomplete triangle.");
  shape = triangle();
  shape.triangles[1] = 3;
  EXPECT_EQ(problemOf(shape), "A triangle of the shape refers to vertex 3 of 3.");
  for (const float value : {std::nanf(""), std::numeric_limits<float>::infinity(), -2e6F}) {
    shape = triangle();
    shape.vertices[1].position[2] = value;
    EXPECT_EQ(problemOf(shape), "Vertex 1 of the shape is not finite or farther away than 1000 km.") << value;
  }
  shape = triangle();
  shape.vertices[2].normal[0] = std::nanf("");
  EXPECT_EQ(problemOf(shape), "Vertex 2 of the shape is not finite or farther away than 1000 km.");
}

}  // namespace
}  // namespace vibe::graphics::coloured_shape_test
