#include "tool_contact/tool_collision.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "vibe_testing/scope_fixture.hpp"

namespace vibe::tool_collision_test {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using Inputs = std::array<double, kJointCount>;

struct Cloud {
  std::vector<double> x, y, z;
  void add(const Vector3d& p) {
    x.push_back(p.x());
    y.push_back(p.y());
    z.push_back(p.z());
  }
  Vector3d at(int i) const { return {x[i], y[i], z[i]}; }
  int count() const { return static_cast<int>(x.size()); }
};

Isometry3d somewhere() {
  Isometry3d base = Isometry3d::Identity();
  base.translate(Vector3d(0.05, -0.02, 0.11));
  base.rotate(AngleAxisd(1.1, Vector3d(1, 2, -1).normalized()));
  return base;
}

std::vector<Isometry3d> linkPoses(const ToolModel& tool, const Inputs& inputs, const Isometry3d& base) {
  std::vector<Isometry3d> poses;
  tool.forwardKinematics(inputs, poses);
  for (Isometry3d& pose : poses) pose = base * pose;
  return poses;
}

Cloud randomCloud(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coordinate(-0.15, 0.15);
  Cloud cloud;
  for (int i = 0; i < count; ++i)
    cloud.add(Vector3d(0.05 + coordinate(random), coordinate(random) - 0.02, 0.11 + coordinate(random)));
  return cloud;
}

int shapeOf(const ToolModel& tool, const std::string& link) {
  for (int s = 0; s < static_cast<int>(tool.shapes().size()); ++s)
    if (tool.shapes()[s].link == tool.linkIndex(link)) return s;
  return -1;
}

// particles around a straight scope: their distance from its tube is known
TEST(ToolCollision, FindsDistanceAndNormalAtTheTube) {
  const ToolModel tool = loadScope();
  const Isometry3d base = somewhere();
  const auto poses = linkPoses(tool, {0.15}, base);
  Cloud cloud;
  const Vector3d outwards(0, 0.6, -0.8);
  for (const double distance : {0.0009, -0.0004, 0.0031})
    cloud.add(base * (Vector3d(-0.17, 0, 0) + (0.0063 + distance) * outwards));
  ToolCollision collision(tool);
  collision.findCandidates(poses, cloud.x.data(), cloud.y.data(), cloud.z.data(), cloud.count(), 0.002);
  EXPECT_EQ(collision.candidateCount(), 2);
  const auto& contacts = collision.findContacts(poses, cloud.x.data(), cloud.y.data(), cloud.z.data(), 0.001);
  ASSERT_EQ(contacts.size(), 2u);
  EXPECT_NEAR(contacts[0].distance, 0.0009, 1e-9);
  EXPECT_NEAR(contacts[1].distance, -0.0004, 1e-9);
  for (const Contact& contact : contacts) {
    EXPECT_EQ(contact.shape, shapeOf(tool, "scope_shaft"));
    EXPECT_LT((contact.normal - base.linear() * outwards).norm(), 1e-6);
  }
}

TEST(ToolCollision, CapIsRoundInFrontOfTheTip) {
  const ToolModel tool = loadScope();
  const Isometry3d base = somewhere();
  const Inputs inputs = {0.1, 0.4, 1.3, -0.5};
  const auto poses = linkPoses(tool, inputs, base);
  const Isometry3d tip = poses[tool.linkIndex("scope_tip")];
  Cloud cloud;
  const Vector3d outward = Vector3d(1, 0, -1).normalized();
  cloud.add(tip * (Vector3d(-0.0079, 0, 0) + (0.0079 + 0.0005) * outward));
  ToolCollision collision(tool);
  collision.findCandidates(poses, cloud.x.data(), cloud.y.data(), cloud.z.data(), 1, 0.002);
  const auto& contacts = collision.findContacts(poses, cloud.x.data(), cloud.y.data(), cloud.z.data(), 0.001);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(tool.shapes()[contacts[0].shape].link, tool.linkIndex("device_cap"));
  EXPECT_NEAR(contacts[0].distance, 0.0005, 1e-8);
  EXPECT_LT((contacts[0].normal - tip.linear() * outward).norm(), 1e-6);
}

// between two segments a particle in the render surface is pushed out sideways, never along the scope
TEST(ToolCollision, NoEdgesBetweenTheSegments) {
  const ToolModel tool = loadScope();
  const auto poses = linkPoses(tool, {0.15}, Isometry3d::Identity());
  ToolCollision collision(tool);
  Cloud cloud;
  for (int i = 0; i < 180; ++i) cloud.add(Vector3d(0.02 + 0.0006 * i, 0.0050, 0));  // to 15 mm behind the tip
  collision.findCandidates(poses, cloud.x.data(), cloud.y.data(), cloud.z.data(), cloud.count(), 0.002);
  std::vector<int> hits(cloud.x.size(), 0);
  for (const Contact& contact : collision.findContacts(poses, cloud.x.data(), cloud.y.data(), cloud.z.data(), 0)) {
    if (contact.distance > -0.0012) continue;  // the end of a neighbour's sphere
    EXPECT_GT(contact.normal.y(), 0.97) << "at x = " << cloud.x[contact.particle];
    ++hits[contact.particle];
  }
  for (std::size_t i = 0; i < hits.size(); ++i) EXPECT_GE(hits[i], 1) << "at x = " << cloud.x[i];
}

TEST(ToolCollision, ContactsComeInOrderOfParticleThenShape) {
  const ToolModel tool = loadScope();
  const Cloud cloud = randomCloud(20000, 5);
  const auto poses = linkPoses(tool, {0.15, 1, 2, 0.5}, somewhere());
  ToolCollision collision(tool);
  collision.findCandidates(poses, cloud.x.data(), cloud.y.data(), cloud.z.data(), cloud.count(), 0.003);
  const auto first = collision.findContacts(poses, cloud.x.data(), cloud.y.data(), cloud.z.data(), 0.003);
  ASSERT_GT(first.size(), 20u);
  for (std::size_t i = 1; i < first.size(); ++i)
    EXPECT_LT(std::make_pair(first[i - 1].particle, first[i - 1].shape),
              std::make_pair(first[i].particle, first[i].shape));

  ToolCollision other(tool);
  other.findCandidates(poses, cloud.x.data(), cloud.y.data(), cloud.z.data(), cloud.count(), 0.003);
  const auto& second = other.findContacts(poses, cloud.x.data(), cloud.y.data(), cloud.z.data(), 0.003);
  ASSERT_EQ(second.size(), first.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(second[i].particle, first[i].particle);
    EXPECT_EQ(second[i].distance, first[i].distance);
    EXPECT_EQ(second[i].normal, first[i].normal);
  }
}

struct Pair {
  int particle, shape;
  bool operator==(const Pair& other) const { return particle == other.particle && shape == other.shape; }
};

// every pair of particle and shape, without candidates
std::vector<Pair> allContacts(const ToolModel& tool, const std::vector<Isometry3d>& poses, const Cloud& cloud,
                              double threshold) {
  std::vector<Pair> result;
  for (int i = 0; i < cloud.count(); ++i) {
    for (int s = 0; s < static_cast<int>(tool.shapes().size()); ++s) {
      const ToolShape& shape = tool.shapes()[s];
      Vector3d normal;
      const Vector3d local = (poses[shape.link] * shape.origin).inverse() * cloud.at(i);
      if (PointDistance(*shape.shape)(local, normal) < threshold) result.push_back({i, s});
    }
  }
  return result;
}

double farthest(const ToolModel& tool, const std::vector<Isometry3d>& from, const std::vector<Isometry3d>& to) {
  double result = 0;
  for (const ToolShape& shape : tool.shapes())
    for (const double x : {-0.4, 0.02})
      for (const double y : {-0.01, 0.01})
        for (const double z : {-0.01, 0.01})
          result = std::max(result, (to[shape.link] * Vector3d(x, y, z) - from[shape.link] * Vector3d(x, y, z)).norm());
  return result;
}

TEST(ToolCollision, CandidatesSufficeForAnyMotionWithinTheReach) {
  const ToolModel tool = loadScope();
  constexpr double kThreshold = 0.00115;
  std::mt19937 random(17);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::size_t found = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const Inputs from = {0.1 + 0.1 * unit(random), 3 * unit(random), 1 + unit(random), unit(random)};
    Inputs to = from;
    to[Insertion] += 0.001 * unit(random);
    for (int i = 1; i < kScopeJointCount; ++i) to[i] += 0.01 * unit(random);
    const auto before = linkPoses(tool, from, somewhere());
    const auto after = linkPoses(tool, to, somewhere());
    Cloud cloud = randomCloud(4000, static_cast<unsigned>(trial));
    constexpr double kDrift = 0.002;
    const double reach = kThreshold + kDrift + farthest(tool, before, after);
    ToolCollision collision(tool);
    collision.findCandidates(before, cloud.x.data(), cloud.y.data(), cloud.z.data(), cloud.count(), reach);
    for (int i = 0; i < cloud.count(); ++i) {
      const Vector3d p = cloud.at(i) + kDrift * Vector3d(unit(random), unit(random), unit(random)).normalized();
      cloud.x[i] = p.x();
      cloud.y[i] = p.y();
      cloud.z[i] = p.z();
    }
    std::vector<Pair> contacts;
    for (const Contact& contact :
         collision.findContacts(after, cloud.x.data(), cloud.y.data(), cloud.z.data(), kThreshold))
      contacts.push_back({contact.particle, contact.shape});
    EXPECT_EQ(contacts, allContacts(tool, after, cloud, kThreshold));
    EXPECT_GE(collision.candidateCount(), static_cast<int>(contacts.size()));
    found += contacts.size();
  }
  EXPECT_GT(found, 100u) << "there was something to miss";
}

TEST(ToolCollision, ParticlesThatAreNotFiniteTouchNothing) {
  const ToolModel tool = loadScope();
  const auto poses = linkPoses(tool, {0.15}, Isometry3d::Identity());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Cloud cloud;
  cloud.add(Vector3d(0.05, 0, 0));
  cloud.add(Vector3d(nan, 0, 0));
  cloud.add(Vector3d(std::numeric_limits<double>::infinity(), 0, 0));
  ToolCollision collision(tool);
  collision.findCandidates(poses, cloud.x.data(), cloud.y.data(), cloud.z.data(), cloud.count(), 0.01);
  EXPECT_GE(collision.candidateCount(), 1);
  cloud.y[0] = nan;
  EXPECT_TRUE(collision.findContacts(poses, cloud.x.data(), cloud.y.data(), cloud.z.data(), 0.01).empty());
}

TEST(ToolCollision, EveryContactHasAUnitNormalAwayFromItsShape) {
  const ToolModel tool = loadScope();
  const Cloud cloud = randomCloud(60000, 9);
  const auto poses = linkPoses(tool, {0.12, 0.2, 2.5, -0.3}, somewhere());
  ToolCollision collision(tool);
  collision.findCandidates(poses, cloud.x.data(), cloud.y.data(), cloud.z.data(), cloud.count(), 0.002);
  const auto& contacts = collision.findContacts(poses, cloud.x.data(), cloud.y.data(), cloud.z.data(), 0.002);
  ASSERT_GT(contacts.size(), 100u);
  for (const Contact& contact : contacts) {
    EXPECT_NEAR(contact.normal.norm(), 1, 1e-9);
    Vector3d normal;
    const ToolShape& shape = tool.shapes()[contact.shape];
    const Vector3d moved = cloud.at(contact.particle) + 1e-4 * contact.normal;
    const double further = PointDistance(*shape.shape)((poses[shape.link] * shape.origin).inverse() * moved, normal);
    EXPECT_NEAR(further, contact.distance + 1e-4, 1e-9);
  }
}

}  // namespace
}  // namespace vibe::tool_collision_test
