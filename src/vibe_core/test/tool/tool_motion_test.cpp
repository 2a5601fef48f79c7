// How the hand moves the joints: it gives way to what it feels.
#include "tool/tool_motion.hpp"

#include <gtest/gtest.h>

namespace vibe::tool_motion_test {
namespace {

using Joints = std::array<double, kJointCount>;

const Joints kStart{0.1, 0, 0.2, 0, 0.01, 0, 0};
const Joints kEnd{0.102, -0.05, 0.25, 0, 0.012, 0.4, 0};
const std::array<double, kScopeJointCount> kEffort{1.0, 0.1, -0.1, 0.1};

TEST(FeltMotion, IsFreeBelowTheForceAtWhichTheHandSlowsDown) {
  EXPECT_EQ(feltMotion(kStart, kEnd, kEffort, 9.9), kEnd);
}

TEST(FeltMotion, StopsOnlyWhatPushesOn) {
  const Joints felt = feltMotion(kStart, kEnd, kEffort, 25);
  EXPECT_EQ(felt[Insertion], kStart[Insertion]) << "pushes against its effort";
  EXPECT_EQ(felt[Rotation], kEnd[Rotation]) << "gives way";
  EXPECT_EQ(felt[TipUpDown], kEnd[TipUpDown]) << "gives way";
  for (int j = kScopeJointCount; j < kJointCount; ++j) EXPECT_EQ(felt[j], kEnd[j]) << "an instrument";
}

TEST(FeltMotion, SlowsDownEvenlyInBetween) {
  double before = kEnd[Insertion] - kStart[Insertion];
  for (double force = 10.5; force < 20; force += 0.5) {
    const double way = feltMotion(kStart, kEnd, kEffort, force)[Insertion] - kStart[Insertion];
    EXPECT_LT(way, before) << force;
    EXPECT_GT(way, 0) << force;
    before = way;
  }
}

}  // namespace
}  // namespace vibe::tool_motion_test
