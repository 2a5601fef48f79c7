#include "geometry/surface_check.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <string>

#include "geometry/test_surfaces.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::surface_check_test {
namespace {

using test::join;
using test::makeBox;
using test::makeTorus;
using test::makeUvSphere;

/// The message with which a surface is refused, empty if it is accepted.
std::string refusal(const SurfaceMesh& mesh) {
  try {
    checkSurface(mesh, "the mesh");
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

void expectRejected(const SurfaceMesh& mesh, const std::string& because) {
  const std::string message = refusal(mesh);
  EXPECT_NE(message.find(because), std::string::npos) << "expected: " << because << "\nmessage:  " << message;
  EXPECT_EQ(message.find("the mesh"), 0u) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

SurfaceMesh sphere() {
  return makeUvSphere(0.05, 10, 16);
}

TEST(SurfaceCheck, acceptsClosedSurfaces) {
  EXPECT_EQ(refusal(sphere()), "");
  EXPECT_EQ(refusal(makeBox(0.1, 0.2, 0.3)), "");
  SurfaceMesh inside_out = sphere();
  for (auto& t : inside_out.triangles) std::swap(t[0], t[1]);
  EXPECT_EQ(refusal(inside_out), "");  // consistent; orientOutwards() turns it
}

TEST(SurfaceCheck, turnsAnInsideOutSurface) {
  SurfaceMesh mesh = sphere();
  EXPECT_FALSE(orientOutwards(mesh));
  const double volume = enclosedVolume(mesh);
  for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
  EXPECT_TRUE(orientOutwards(mesh));
  EXPECT_DOUBLE_EQ(enclosedVolume(mesh), volume);
}

TEST(SurfaceCheck, refusesNoTriangles) {
  expectRejected(SurfaceMesh{}, "no faces");
}

TEST(SurfaceCheck, refusesNumbersThatAreNone) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), -1e308}) {
    SurfaceMesh mesh = sphere();
    mesh.vertices[7].y() = bad;
    mesh.vertices[9].z() = bad;
    expectRejected(mesh, "2 vertices whose position is not a finite number below 1e100, the first is number 7");
  }
}

TEST(SurfaceCheck, refusesVerticesThatAreNotThere) {
  for (const int bad : {-1, 100000}) {
    SurfaceMesh mesh = sphere();
    mesh.triangles[3][1] = bad;
    expectRejected(mesh, "triangle (number 3) with vertex " + std::to_string(bad));
  }
}

TEST(SurfaceCheck, refusesTrianglesWithoutArea) {
  SurfaceMesh mesh = sphere();
  const auto t = mesh.triangles[5];
  mesh.vertices[t[0]] = 0.5 * (mesh.vertices[t[1]] + mesh.vertices[t[2]]);
  expectRejected(mesh, "1 triangle without area, the first is number 5");
}

TEST(SurfaceCheck, refusesHolesAndCountsThem) {
  SurfaceMesh mesh = sphere();
  mesh.triangles.erase(mesh.triangles.begin() + 40);
  expectRejected(mesh, "1 hole with 3 open edges");
  mesh.triangles.erase(mesh.triangles.begin());
  expectRejected(mesh, "2 holes with 6 open edges");
}

TEST(SurfaceCheck, refusesATriangleThatFacesTheOtherWay) {
  SurfaceMesh mesh = sphere();
  std::swap(mesh.triangles[20][0], mesh.triangles[20][1]);
  expectRejected(mesh, "3 edges between triangles that face opposite sides");
}

TEST(SurfaceCheck, refusesADoubledFace) {
  SurfaceMesh mesh = sphere();
  mesh.triangles.push_back(mesh.triangles[10]);
  expectRejected(mesh, "3 edges with more than two triangles");
}

TEST(SurfaceCheck, refusesTwoTrianglesBackToBack) {
  SurfaceMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {2, 1, 0}};
  expectRejected(mesh, "two triangles back to back, numbers 0 and 1");
}

TEST(SurfaceCheck, refusesSheetsThatTouchInAPoint) {
  SurfaceMesh mesh = join(makeBox(0.1, 0.1, 0.1), makeBox(0.1, 0.1, 0.1), {0.1, 0.1, 0.1});
  for (auto& t : mesh.triangles) {
    for (int& v : t) {
      if (v == 8) v = 7;  // the corner where the boxes meet
    }
  }
  expectRejected(mesh, "touches itself at vertex 7");
}

TEST(SurfaceCheck, refusesSeveralPartsAndNamesTheirSizes) {
  expectRejected(join(sphere(), makeBox(0.01, 0.01, 0.01), {0.2, 0, 0}), "2 separate parts (with 288, 12 triangles)");
}

TEST(SurfaceCheck, refusesARing) {
  expectRejected(makeTorus(0.05, 0.02, 20, 10), "1 handle");
}

TEST(SurfaceCheck, refusesASurfaceThroughItself) {
  SurfaceMesh mesh = sphere();
  mesh.vertices[0].z() = -0.08;  // the north pole pulled out through the south
  expectRejected(mesh, "passes through itself");
}

TEST(SurfaceCheck, refusesASurfaceWithoutThickness) {
  EXPECT_EQ(refusal(makeBox(0.1, 0.2, 1e-4)), "");
  expectRejected(makeBox(0.1, 0.2, 1e-9),
                 "encloses next to nothing, 2e-11 cubic units, with a largest side of 0.2 units");
}

/// Damages the surface in one of the ways a file can be wrong; returns how.
std::string damage(SurfaceMesh& mesh, std::mt19937& random) {
  const auto pick = [&](std::size_t count) { return static_cast<int>(random() % count); };
  const int triangle = pick(mesh.triangles.size());
  const int vertex = pick(mesh.vertices.size());
  switch (random() % 8) {
    case 0:
      mesh.triangles.erase(mesh.triangles.begin() + triangle);
      return "deleted triangle";
    case 1:
      std::swap(mesh.triangles[triangle][0], mesh.triangles[triangle][2]);
      return "turned triangle";
    case 2:
      mesh.vertices.push_back(mesh.vertices[mesh.triangles[triangle][0]]);
      mesh.triangles[triangle][0] = static_cast<int>(mesh.vertices.size()) - 1;
      return "doubled vertex";
    case 3:
      mesh.vertices[vertex][static_cast<int>(random() % 3)] = std::nan("");
      return "not a number";
    case 4:
      mesh.vertices[vertex] *= -1.5;
      return "vertex beyond the other side";
    case 5:
      mesh.triangles.push_back(mesh.triangles[triangle]);
      return "doubled triangle";
    case 6:
      mesh.triangles.resize(1 + pick(mesh.triangles.size() - 1));
      return "cut off";
    default:
      mesh.triangles[triangle][1] = mesh.triangles[triangle][0];
      return "triangle without area";
  }
}

TEST(SurfaceCheck, refusesEveryDamageWithOneSentence) {
  const SurfaceMesh whole = makeUvSphere(0.05, 9, 13);
  std::mt19937 random(20);
  for (int k = 0; k < 200; ++k) {
    SurfaceMesh mesh = whole;
    const std::string how = damage(mesh, random);
    const std::string message = refusal(mesh);
    EXPECT_FALSE(message.empty()) << how << ", case " << k;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_NE(message.find(';'), std::string::npos) << "no remedy: " << message;
  }
}

}  // namespace
}  // namespace vibe::surface_check_test
