#include "camera/frame_timing.hpp"

#include <gtest/gtest.h>

namespace vibe::vision::interval_gaps_test {

TEST(IntervalGaps, CountsFramesThatAreLeftOut) {
  IntervalGaps gaps(0.01);
  EXPECT_EQ(gaps.advance(10), 0U);
  EXPECT_EQ(gaps.advance(10.011), 0U);
  EXPECT_EQ(gaps.advance(10.0195), 0U);
  EXPECT_EQ(gaps.advance(10.04), 1U);
  EXPECT_EQ(gaps.advance(10.09), 4U);
}

TEST(IntervalGaps, ACameraThatRunsMoreSlowlyThanAskedLosesNothing) {
  IntervalGaps gaps(0.01);
  std::uint64_t lost = 0, late = 0;
  for (int k = 0; k < 200; ++k) (k < 40 ? lost : late) += gaps.advance(10 + 0.02 * k);
  EXPECT_GT(lost, 0U);  // not known yet
  EXPECT_EQ(late, 0U);
  EXPECT_EQ(gaps.advance(10 + 0.02 * 201), 1U);
}

TEST(IntervalGaps, AClockThatIsSetIsNoGap) {
  IntervalGaps gaps(0.01);
  gaps.advance(10);
  EXPECT_EQ(gaps.advance(1.7e9), 0U);
  EXPECT_EQ(gaps.advance(10), 0U);
}

}  // namespace vibe::vision::interval_gaps_test
