#include "vibe_core/tool/tool_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <new>
#include <random>

#include "tool/tip_chain.hpp"
#include "tool/tool_motion.hpp"
#include "vibe_testing/expect_error.hpp"
#include "vibe_testing/scope_fixture.hpp"

// counts what is allocated, for the promise that forwardKinematics allocates nothing
static long allocations = 0;
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace vibe::tool_model_test {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Translation3d;
using Eigen::Vector3d;
using Inputs = std::array<double, kJointCount>;

// of scope.urdf
constexpr double kBendLength = 0.088;
constexpr double kTipLength = 0.016;
constexpr int kSegments = 8;

Isometry3d tipPose(const ToolModel& tool, const Inputs& inputs) {
  std::vector<Isometry3d> poses;
  tool.forwardKinematics(inputs, poses);
  return poses[tool.linkIndex("scope_tip")];
}

Inputs randomInputs(const ToolModel& tool, std::mt19937& random) {
  Inputs inputs{};
  for (int i = 0; i < kJointCount; ++i)
    inputs[i] = std::uniform_real_distribution<double>(tool.limits()[i].lower, tool.limits()[i].upper)(random);
  return inputs;
}

TEST(ToolModel, ChainToTheTipHasTheSameBits) {
  const ToolModel tool = loadScope();
  TipChain chain(tool);
  std::mt19937 random(1);
  for (int k = 0; k < 100; ++k) {
    const Inputs inputs = randomInputs(tool, random);
    std::vector<Isometry3d> poses;
    tool.forwardKinematics(inputs, poses);
    chain.place(inputs);
    for (int link = 0; link < chain.count(); ++link)
      EXPECT_EQ(chain.pose(link).matrix(), poses[chain.joint(link).child_link].matrix());
  }
  EXPECT_EQ(chain.joint(chain.count() - 1).child_link, tool.linkIndex("scope_tip"));
}

TEST(ToolModel, StraightScopeHasItsTipAtTheInsertion) {
  const ToolModel tool = loadScope();
  EXPECT_TRUE(tipPose(tool, {}).isApprox(Isometry3d::Identity(), 1e-12));
  const Isometry3d tip = tipPose(tool, {0.12, 0.7});
  EXPECT_LT((tip.translation() - Vector3d(0.12, 0, 0)).norm(), 1e-12);
  EXPECT_LT((tip.linear() - AngleAxisd(0.7, Vector3d::UnitX()).toRotationMatrix()).norm(), 1e-12);
}

// an arc of length L and total angle a ends at L/a (sin a, 1 - cos a); the chain of N joints in the middle of equal
// lengths ends at the same direction times (a/2N) / tan(a/2N)
TEST(ToolModel, BendingSectionFollowsAnArcOfConstantCurvature) {
  const ToolModel tool = loadScope();
  for (const double angle : {-1.5, -0.6, 0.1, 0.5, 1.0, 1.7, 2.2, 2.86}) {
    const Isometry3d tip = tipPose(tool, {0, 0, angle, 0});
    const Vector3d direction(std::cos(angle), 0, std::sin(angle));
    EXPECT_LT((tip.linear().col(0) - direction).norm(), 1e-9) << "up is +z at angle " << angle;
    const Vector3d start(-kBendLength - kTipLength, 0, 0);
    const Vector3d end = tip.translation() - kTipLength * direction - start;
    const Vector3d arc = kBendLength / angle * Vector3d(std::sin(angle), 0, 1 - std::cos(angle));
    const double half = angle / (2 * kSegments);
    EXPECT_LT((end - arc * (half / std::tan(half))).norm(), 1e-9);
    EXPECT_LT((end - arc).norm(), 0.0108 * arc.norm()) << "difference that N = 8 leaves";
  }
}

TEST(ToolModel, LeftIsPositive) {
  const Isometry3d tip = tipPose(loadScope(), {0, 0, 0, 1.0});
  EXPECT_LT((tip.linear().col(0) - Vector3d(std::cos(1.0), std::sin(1.0), 0)).norm(), 1e-9);
  EXPECT_GT(tip.translation().y(), 0.02);
}

TEST(ToolModel, RotationTurnsTheBentTipAboutTheShaft) {
  const ToolModel tool = loadScope();
  const Vector3d before = tipPose(tool, {0.1, 0, 1.2, -0.4}).translation();
  const Vector3d after = tipPose(tool, {0.1, 0.9, 1.2, -0.4}).translation();
  EXPECT_LT((after - AngleAxisd(0.9, Vector3d::UnitX()) * before).norm(), 1e-12);
}

// the same pose from a product that is written down here and knows nothing of the URDF
TEST(ToolModel, AgreesWithAProductOfMatrices) {
  const ToolModel tool = loadScope();
  std::mt19937 random(7);
  for (int trial = 0; trial < 50; ++trial) {
    const Inputs q = randomInputs(tool, random);
    const double h = kBendLength / kSegments;
    Isometry3d expected = Isometry3d::Identity();
    expected.translate(Vector3d(q[Insertion], 0, 0));
    expected.translate(Vector3d(-(kBendLength - h / 2 + kTipLength), 0, 0));
    expected.rotate(AngleAxisd(q[Rotation], Vector3d::UnitX()));
    for (int k = 0; k < kSegments; ++k) {
      expected.rotate(AngleAxisd(-q[TipUpDown] / kSegments, Vector3d::UnitY()));
      expected.rotate(AngleAxisd(q[TipLeftRight] / kSegments, Vector3d::UnitZ()));
      expected.translate(Vector3d(k + 1 < kSegments ? h : h / 2 + kTipLength, 0, 0));
    }
    std::vector<Isometry3d> poses;
    tool.forwardKinematics(q, poses);
    EXPECT_LT((poses[tool.linkIndex("scope_tip")].matrix() - expected.matrix()).norm(), 1e-9);

    Isometry3d helix = expected * Translation3d(-0.002 + q[HelixAdvance], 0.0028, -0.0022);
    helix.rotate(AngleAxisd(q[HelixRotation], Vector3d::UnitX()));
    EXPECT_LT((poses[tool.linkIndex("helix")].matrix() - helix.matrix()).norm(), 1e-9);
    const Vector3d needle = expected * (Vector3d(0.0148, -0.0025, 0.0134) + q[NeedleDriver] * Vector3d(-0.6, 0, -0.8));
    EXPECT_LT((poses[tool.linkIndex("needle")].translation() - needle).norm(), 1e-9);
  }
}

TEST(ToolModel, CameraLooksAlongTheTip) {
  const ToolModel tool = loadScope();
  std::vector<Isometry3d> poses;
  tool.forwardKinematics({0.1, 0.3, 0.8, 0.2}, poses);
  const Isometry3d tip = poses[tool.linkIndex("scope_tip")];
  const Isometry3d camera = poses[tool.linkIndex("scope_camera_optical")];
  EXPECT_LT((camera.linear().col(2) - tip.linear().col(0)).norm(), 1e-9);  // z forward
  EXPECT_LT((camera.linear().col(0) + tip.linear().col(1)).norm(), 1e-9);  // x right
  EXPECT_LT((camera.linear().col(1) + tip.linear().col(2)).norm(), 1e-9);  // y down
}

TEST(ToolModel, LinksAreNumberedParentFirst) {
  const ToolModel tool = loadScope();
  EXPECT_EQ(tool.linkName(0), "scope_base");
  for (int k = 0; k < static_cast<int>(tool.joints().size()); ++k) {
    EXPECT_EQ(tool.joints()[k].child_link, k + 1);
    EXPECT_LT(tool.joints()[k].parent_link, k + 1);
  }
  EXPECT_EQ(tool.linkCount(), static_cast<int>(tool.joints().size()) + 1);
  EXPECT_EQ(errorOf([&] { tool.linkIndex("elbow"); }), "The tool has no link 'elbow'; its URDF must define it.");
}

TEST(ToolModel, ForwardKinematicsAllocatesNothing) {
  const ToolModel tool = loadScope();
  std::vector<Isometry3d> poses;
  tool.forwardKinematics({}, poses);
  const long before = allocations;
  for (int i = 0; i < 10; ++i) tool.forwardKinematics({0.01 * i, 0.1, 0.2, 0.3}, poses);
  EXPECT_EQ(allocations, before);
  poses.clear();
  poses.shrink_to_fit();
  tool.forwardKinematics({}, poses);
  EXPECT_GT(allocations, before) << "the counter counts";
}

TEST(ToolMotion, PosesAreThoseOfThePlaceWhateverWasAskedBefore) {
  const ToolModel tool = loadScope();
  const Isometry3d base(Translation3d(0.1, 0.2, 0.3));
  std::mt19937 random(3);
  LinkPoses kept;
  for (int trial = 0; trial < 50; ++trial) {
    const Inputs from = randomInputs(tool, random), to = trial % 3 == 0 ? from : randomInputs(tool, random);
    ToolMotion motion(tool, base, from, to);
    motion.displaceEnd({0.01 * (trial % 2), 0.1 * (trial % 4)});
    for (const double fraction : {1.0, 1.0, 0.0, 0.5, 0.0}) {
      motion.linkPoses(fraction, kept);
      std::vector<Isometry3d> expected;
      tool.forwardKinematics(motion.inputs(fraction), motion.displacement(fraction), expected);
      for (std::size_t k = 0; k < expected.size(); ++k)
        ASSERT_TRUE(kept[k].matrix() == (base * expected[k]).matrix()) << "trial " << trial << ", link " << k;
    }
  }
}

TEST(ToolModel, LimitsComeFromTheInputJoints) {
  const ToolModel tool = loadScope();
  EXPECT_EQ(tool.limits()[Insertion].lower, 0);
  EXPECT_EQ(tool.limits()[Insertion].upper, 0.3);
  EXPECT_NEAR(tool.limits()[TipUpDown].upper, 164 * M_PI / 180, 1e-8);
  EXPECT_NEAR(tool.limits()[TipUpDown].lower, -90 * M_PI / 180, 1e-8);
  EXPECT_NEAR(tool.limits()[TipLeftRight].upper, 100 * M_PI / 180, 1e-8);
  for (const JointLimits& limit : tool.limits()) {
    EXPECT_LT(limit.lower, limit.upper);
    EXPECT_GT(limit.velocity, 0);
  }
}

TEST(ToolModel, InverseKinematicsFindsReachablePoses) {
  const ToolModel tool = loadScope();
  std::mt19937 random(11);
  for (int trial = 0; trial < 200; ++trial) {
    Inputs goal = randomInputs(tool, random);
    const Isometry3d target = tipPose(tool, goal);
    Inputs start = randomInputs(tool, random);
    const Inputs found = tool.inverseKinematics(target, start);
    const Isometry3d reached = tipPose(tool, found);
    EXPECT_LT((reached.translation() - target.translation()).norm(), 1e-3) << "trial " << trial;
    EXPECT_LT((reached.linear().col(0) - target.linear().col(0)).norm(), 0.06) << "trial " << trial;
    for (int i = kScopeJointCount; i < kJointCount; ++i) EXPECT_EQ(found[i], start[i]);
  }
}

TEST(ToolModel, InverseKinematicsIsExactNearTheStart) {
  const ToolModel tool = loadScope();
  std::mt19937 random(12);
  std::uniform_real_distribution<double> nearby(-1, 1);
  for (int trial = 0; trial < 200; ++trial) {
    const Inputs goal = randomInputs(tool, random);
    Inputs start = goal;
    start[Insertion] += 0.005 * nearby(random);
    for (int i = 1; i < kScopeJointCount; ++i) start[i] += 0.1 * nearby(random);
    const Isometry3d target = tipPose(tool, goal);
    const Isometry3d reached = tipPose(tool, tool.inverseKinematics(target, start));
    EXPECT_LT((reached.translation() - target.translation()).norm(), 1e-7) << "trial " << trial;
    EXPECT_LT((reached.linear().col(0) - target.linear().col(0)).norm(), 1e-5) << "trial " << trial;
  }
}

TEST(ToolModel, InverseKinematicsStaysWithinTheLimits) {
  const ToolModel tool = loadScope();
  for (const Vector3d& far : {Vector3d(1, 0, 0), Vector3d(-1, 0.2, 0), Vector3d(0.1, 2, -1), Vector3d(0, 0, 0)}) {
    Isometry3d target = Isometry3d::Identity();
    target.translation() = far;
    const Inputs found = tool.inverseKinematics(target, {0.1, 0, 0.3, 0});
    for (int i = 0; i < kScopeJointCount; ++i) {
      EXPECT_GE(found[i], tool.limits()[i].lower);
      EXPECT_LE(found[i], tool.limits()[i].upper);
    }
  }
  Isometry3d ahead = Isometry3d::Identity();
  ahead.translation().x() = 1;
  EXPECT_NEAR(tool.inverseKinematics(ahead, {0.1, 0.2, 0.3, 0.1})[Insertion], 0.3, 1e-6);
}

// The square of distance and turn, of which 0.02 m count as a radian.
double missOf(const ToolModel& tool, const Inputs& inputs, const Isometry3d& target) {
  const Isometry3d there = tipPose(tool, inputs);
  const double turn = std::acos(std::clamp(there.linear().col(0).dot(target.linear().col(0)), -1.0, 1.0));
  return (there.translation() - target.translation()).squaredNorm() + std::pow(0.02 * turn, 2);
}

TEST(ToolModel, InverseKinematicsComesAsNearAsItCanToWhatIsOutOfReach) {
  const ToolModel tool = loadScope();
  std::mt19937 random(13);
  for (int trial = 0; trial < 50; ++trial) {
    Isometry3d target = tipPose(tool, randomInputs(tool, random));
    target.linear() = Eigen::AngleAxisd(1.2, target.linear().col(1)) * target.linear();
    const Inputs found = tool.inverseKinematics(target, randomInputs(tool, random));
    const double miss = missOf(tool, found, target);
    for (int i = 0; i < kScopeJointCount; ++i)
      for (const double by : {-1e-3, 1e-3}) {
        Inputs beside = found;
        beside[i] = std::clamp(found[i] + by, tool.limits()[i].lower, tool.limits()[i].upper);
        EXPECT_GE(missOf(tool, beside, target), miss * (1 - 1e-6)) << "trial " << trial << ", input " << i;
      }
  }
}

TEST(ToolModel, InverseKinematicsKeepsWhatIsAlreadyThere) {
  const ToolModel tool = loadScope();
  for (const Inputs& inputs : {Inputs{0.1, 0.4, 0, 0}, Inputs{0.2, -1, 1.5, 0.5}, Inputs{0, 3, -1, 1}}) {
    const Inputs found = tool.inverseKinematics(tipPose(tool, inputs), inputs);
    for (int i = 0; i < kJointCount; ++i) EXPECT_NEAR(found[i], inputs[i], 1e-9);
  }
}

}  // namespace
}  // namespace vibe::tool_model_test
