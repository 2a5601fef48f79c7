// The triangles of a robot description in the truth: those of the mesh files, all of them and at their places.
#include "robot_shapes.hpp"

#include <gtest/gtest.h>
#include <ros/package.h>

#include <Eigen/Geometry>
#include <fstream>
#include <map>
#include <sstream>

namespace vibe::endoscope::robot_shapes_test {
namespace {

const std::string kAddress = "package://vibe_description/";

std::string folder() {
  return ros::package::getPath("vibe_description") + "/";
}

std::string textOf(const std::string& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

struct Extent {
  std::size_t triangles = 0;
  Eigen::AlignedBox3f box;
};

/// What an OBJ file of triangles says of itself.
Extent extentOfFile(const std::string& file) {
  std::istringstream lines(textOf(file));
  Extent extent;
  std::string kind, line;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    Eigen::Vector3f v;
    if (words >> kind && kind == "v" && words >> v.x() >> v.y() >> v.z()) extent.box.extend(v);
    extent.triangles += kind == "f" ? 1 : 0;
  }
  return extent;
}

Extent extentOf(const graphics::ColouredShape& shape) {
  Extent extent;
  extent.triangles = shape.triangles.size() / 3;
  for (const std::uint32_t corner : shape.triangles)
    extent.box.extend(Eigen::Map<const Eigen::Vector3f>(shape.vertices[corner].position));
  return extent;
}

void expectSame(const Extent& a, const Extent& b, const std::string& what) {
  EXPECT_EQ(a.triangles, b.triangles) << what;
  EXPECT_LT((a.box.min() - b.box.min()).norm() + (a.box.max() - b.box.max()).norm(), 1e-7F) << what;
}

std::string oneMesh(const std::string& attributes, const std::string& origin = "") {
  return "<robot name='r'><link name='a'><visual>" + origin + "<geometry><mesh filename='" + kAddress + "meshes/" +
         attributes + "/></geometry></visual></link></robot>";
}

TEST(RobotShapes, TheEndoscopeHasTheTrianglesOfItsFiles) {
  const std::string urdf = textOf(folder() + "urdf/scope.urdf");
  std::vector<std::string> problems;
  std::map<std::string, Extent> parts;
  for (const RobotShape& part : robotShapes(urdf, problems)) parts[part.frame] = extentOf(part.shape);
  EXPECT_TRUE(problems.empty());
  const auto visuals = robotVisuals(urdf);
  ASSERT_TRUE(visuals);
  ASSERT_GE(visuals->size(), 20u);
  EXPECT_EQ(parts.size(), visuals->size());
  for (const RobotVisual& visual : *visuals) {
    ASSERT_EQ(visual.mesh.compare(0, kAddress.size(), kAddress), 0) << visual.link;
    const Extent file = extentOfFile(folder() + visual.mesh.substr(kAddress.size()));
    ASSERT_GT(file.triangles, 100u) << visual.mesh;
    expectSame(parts[visual.link], file, visual.link);
  }
  EXPECT_EQ(parts.count("argon_probe") + parts.count("suture_needle"), 2u);
}

TEST(RobotShapes, MeshesAreScaledAndThenPlaced) {
  std::vector<std::string> problems;
  const auto made = robotShapes(oneMesh("tip.obj' scale='2 1 1'", "<origin xyz='0 0 1' rpy='0 0 0'/>"), problems);
  ASSERT_EQ(made.size(), 1u);
  Extent file = extentOfFile(folder() + "meshes/tip.obj");
  const Eigen::Vector3f twice(2, 1, 1), up(0, 0, 1);
  file.box = Eigen::AlignedBox3f(file.box.min().cwiseProduct(twice) + up, file.box.max().cwiseProduct(twice) + up);
  expectSame(extentOf(made[0].shape), file, "tip");
  // control: the extent of a mesh that is not placed is another one
  const auto plain = robotShapes(oneMesh("tip.obj'"), problems);
  EXPECT_GT((extentOf(plain[0].shape).box.max() - file.box.max()).norm(), 0.5F);
}

TEST(RobotShapes, BodiesAndMeshesOfOnePartAreOneShape) {
  std::vector<std::string> problems;
  const auto shapes = robotShapes(
      "<robot name='r'><link name='a'>"
      "<visual><geometry><box size='1 2 3'/></geometry></visual>"
      "<visual><geometry><mesh filename='" +
          kAddress +
          "meshes/tip.obj'/></geometry></visual>"
          "<visual name='eye'><geometry><sphere radius='0.1'/></geometry></visual></link></robot>",
      problems);
  ASSERT_EQ(shapes.size(), 2u);
  EXPECT_EQ(shapes[0].name, "a");
  EXPECT_EQ(shapes[1].name, "a/eye");
  EXPECT_EQ(shapes[1].frame, "a");
  const Extent both = extentOf(shapes[0].shape);
  EXPECT_EQ(both.triangles, 12 + extentOfFile(folder() + "meshes/tip.obj").triangles);
  EXPECT_NEAR(both.box.max().z(), 1.5F, 1e-6F);
}

TEST(RobotShapes, WhatCannotBeReadIsToldInOneSentence) {
  std::vector<std::string> problems;
  EXPECT_TRUE(robotShapes(oneMesh("nowhere.obj'"), problems).empty());
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].find("nowhere.obj"), std::string::npos) << problems[0];
  EXPECT_TRUE(robotShapes("no robot", problems).empty());
  EXPECT_EQ(problems.size(), 2u);
}

}  // namespace
}  // namespace vibe::endoscope::robot_shapes_test
