// the endoscope's URDF as a description of a body, read through urdfdom

#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include <BulletCollision/CollisionShapes/btConvexShape.h>
#include <Eigen/Dense>
#include <cstdio>
#include <memory>
#include <set>

#include "vibe_testing/scope_fixture.hpp"

namespace vibe::scope_urdf_test {
namespace {

urdf::ModelInterfaceSharedPtr parsedScope() {
  return urdf::parseURDF(scopeText());
}

std::set<std::string> namesOf(const std::map<std::string, urdf::LinkSharedPtr>& links) {
  std::set<std::string> names;
  for (const auto& entry : links) names.insert(entry.first);
  return names;
}

std::string outputOf(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string output;
  char buffer[4096];
  while (const std::size_t n = fread(buffer, 1, sizeof buffer, pipe.get())) output.append(buffer, n);
  return output;
}

// The simulation knows nothing of them.
const std::set<std::string> kDrawn = {"needle_arm",   "needle_arm_pin",  "needle_hook",   "needle_hook_pin",
                                      "needle_depth", "needle_carriage", "suture_needle", "argon_probe"};

TEST(ScopeUrdf, IsWhatItsProgramWrites) {
  const std::string program = std::string(VIBE_DESCRIPTION_DIR) + "/scripts/make_scope_urdf.py";
  EXPECT_EQ(outputOf("/usr/bin/python3 -B '" + program + "'"), scopeText())
      << "run scripts/make_scope_urdf.py > urdf/scope.urdf in vibe_description";
}

TEST(ScopeUrdf, HasTheLinksThatOthersNeed) {
  const auto scope = parsedScope();
  ASSERT_TRUE(scope);
  EXPECT_EQ(scope->getRoot()->name, "scope_base");
  std::set<std::string> expected = {
      "scope_base", "scope_slide",      "scope_shaft",    "up_down_wheel", "scope_tip", "scope_camera_optical",
      "device_cap", "left_right_wheel", "helix_carriage", "helix",         "needle",    "scope_neck"};
  expected.insert(kDrawn.begin(), kDrawn.end());
  for (int k = 1; k <= 7; ++k) {
    expected.insert("shaft_yoke_" + std::to_string(k));
    expected.insert("shaft_" + std::to_string(k));
  }
  for (int k = 1; k <= 8; ++k) {
    expected.insert("ring_" + std::to_string(k));
    expected.insert("segment_" + std::to_string(k));
  }
  EXPECT_EQ(namesOf(scope->links_), expected);
  EXPECT_EQ(scope->joints_.size() + 1, scope->links_.size());
}

TEST(ScopeUrdf, JointsAreInputsOrMimicThemOrBelongToTheShaft) {
  std::set<std::string> inputs(kJointNames.begin(), kJointNames.end());
  int mimicking = 0, passive = 0;
  const auto scope = parsedScope();
  for (const auto& entry : scope->joints_) {
    const urdf::Joint& joint = *entry.second;
    if (joint.type == urdf::Joint::FIXED) continue;
    ASSERT_TRUE(joint.limits) << joint.name;
    if (joint.name.compare(0, 6, "shaft_") == 0) {
      ++passive;
      EXPECT_FALSE(joint.mimic) << joint.name;
      continue;
    }
    if (!joint.mimic) {
      EXPECT_EQ(inputs.erase(joint.name), 1u) << joint.name;
      continue;
    }
    if (kDrawn.count(joint.child_link_name) != 0) {
      EXPECT_EQ(joint.mimic->joint_name, "needle_driver") << joint.name << ": an input that no scope gives way in";
      continue;
    }
    ++mimicking;
    const urdf::Joint& source = *scope->joints_.at(joint.mimic->joint_name);
    EXPECT_NEAR(joint.mimic->multiplier, 0.125, 1e-12);
    EXPECT_NEAR(joint.limits->upper, source.limits->upper / 8, 1e-9) << joint.name;
    EXPECT_NEAR(joint.limits->lower, source.limits->lower / 8, 1e-9) << joint.name;
  }
  EXPECT_TRUE(inputs.empty());
  EXPECT_EQ(mimicking, 16);
  EXPECT_EQ(passive, 14) << "the shaft bends in two directions at seven places";
}

TEST(ScopeUrdf, EveryMovingLinkHasAPossibleBody) {
  const auto scope = parsedScope();
  double total = 0;
  for (const auto& entry : scope->joints_) {
    const urdf::Joint& joint = *entry.second;
    const urdf::Link& link = *scope->links_.at(joint.child_link_name);
    if (joint.type == urdf::Joint::FIXED && !link.inertial) continue;
    ASSERT_TRUE(link.inertial) << link.name;
    const urdf::Inertial& body = *link.inertial;
    Eigen::Matrix3d inertia;
    inertia << body.ixx, body.ixy, body.ixz, body.ixy, body.iyy, body.iyz, body.ixz, body.iyz, body.izz;
    const Eigen::Vector3d moments = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia).eigenvalues();
    EXPECT_GT(body.mass, 1e-6) << link.name;
    EXPECT_GT(moments[0], 0) << link.name;
    EXPECT_LE(moments[2], moments[0] + moments[1]) << link.name << ": no body has such moments";
    const double size = std::sqrt(moments[2] / body.mass);  // radius of gyration
    EXPECT_GT(size, 1e-4) << link.name;
    EXPECT_LT(size, 0.2) << link.name;
    total += body.mass;
  }
  EXPECT_GT(total, 0.05) << "45 cm of a 12.6 mm endoscope";
  EXPECT_LT(total, 0.2);
}

TEST(ScopeUrdf, EveryPartThatCanTouchTheWallHasACollisionShape) {
  const auto scope = parsedScope();
  std::vector<std::string> touching = {"scope_shaft", "scope_tip", "device_cap"};
  for (int k = 1; k <= 8; ++k) touching.push_back("segment_" + std::to_string(k));
  for (int k = 1; k <= 6; ++k) touching.push_back("shaft_" + std::to_string(k));
  for (const std::string& name : touching) EXPECT_FALSE(scope->links_.at(name)->collision_array.empty()) << name;
  for (const char* name : {"helix", "needle"})
    EXPECT_TRUE(scope->links_.at(name)->collision_array.empty()) << name << " penetrates the wall";
  EXPECT_EQ(loadScope().shapes().size(), 17u) << "capsules of shaft and its pieces, segments, tip and device";
  const ToolModel with_arm = ToolModel::fromUrdf(scopeText(), "scope.urdf", NeedleArm::Body);
  EXPECT_EQ(with_arm.shapes().size(), 20u) << "and one of the needle arm, two of its hook";
}

TEST(ScopeUrdf, WhatIsOnlyDrawnTouchesNothingAndCarriesNothingElse) {
  const auto scope = parsedScope();
  std::size_t meshes = 0;
  for (const std::string& name : kDrawn) {
    const urdf::Link& link = *scope->links_.at(name);
    const bool arm = name == "needle_arm" || name == "needle_hook";  // bodies where a scene asks for it
    EXPECT_EQ(link.collision_array.empty(), !arm) << name;
    meshes += link.visual_array.size();
    for (const auto& child : link.child_links) EXPECT_EQ(kDrawn.count(child->name), 1U) << child->name;
  }
  EXPECT_EQ(meshes, 4u) << "arm, hook, needle, probe";
  EXPECT_TRUE(scope->links_.at("needle")->visual_array.empty());
}

// 15.8 mm with the arm closed (SAGES Manual of Flexible Endoscopy); the shapes end at the distal face, the bracket has
// none
TEST(ScopeUrdf, IsAsWideAsTheRealDevice) {
  const ToolModel tool = loadScope();
  std::vector<Eigen::Isometry3d> poses;
  tool.forwardKinematics({}, poses);
  double widest = 0;
  double foremost = 0;
  for (const ToolShape& shape : tool.shapes()) {
    btVector3 lower, upper;
    shape.shape->getAabb(btTransform::getIdentity(), lower, upper);
    for (const btVector3& corner : {lower, upper}) {
      const Eigen::Vector3d p = poses[shape.link] * shape.origin * Eigen::Vector3d(corner.x(), corner.y(), corner.z());
      widest = std::max(widest, std::abs(p.z()));
      foremost = std::max(foremost, p.x());
    }
  }
  EXPECT_NEAR(2 * widest, 0.0158, 1e-6);
  EXPECT_NEAR(foremost, 0, 1e-6);
}

}  // namespace
}  // namespace vibe::scope_urdf_test
