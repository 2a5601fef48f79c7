#include "camera/frame_timing.hpp"

#include <gtest/gtest.h>

namespace vibe::vision::sequence_counter_test {

TEST(SequenceCounter, CountsGaps) {
  SequenceCounter counter;
  EXPECT_EQ(counter.advance(10).skipped, 0U);
  EXPECT_EQ(counter.advance(11).skipped, 0U);
  const SequenceCounter::Step step = counter.advance(15);
  EXPECT_EQ(step.sequence, 15U);
  EXPECT_EQ(step.skipped, 3U);
}

TEST(SequenceCounter, SixteenBitsWrapToOne) {
  SequenceCounter counter;
  counter.advance(65534);
  EXPECT_EQ(counter.advance(65535).sequence, 65535U);
  EXPECT_EQ(counter.advance(1).sequence, 65536U);
  const SequenceCounter::Step step = counter.advance(4);
  EXPECT_EQ(step.sequence, 65539U);
  EXPECT_EQ(step.skipped, 2U);
}

TEST(SequenceCounter, LongNumbersDoNotWrap) {
  SequenceCounter counter;
  counter.advance(65535);
  EXPECT_EQ(counter.advance(65536).skipped, 0U);
  EXPECT_EQ(counter.advance(65537).sequence, 65537U);
}

TEST(SequenceCounter, ACameraThatCountsAnewContinuesTheSequence) {
  SequenceCounter counter;
  counter.advance(500);
  counter.restart();
  const SequenceCounter::Step step = counter.advance(1);
  EXPECT_EQ(step.sequence, 501U);
  EXPECT_EQ(step.skipped, 0U);
  EXPECT_EQ(counter.advance(2).sequence, 502U);
}

TEST(SequenceCounter, NumbersThatGoBackAreNoGap) {
  SequenceCounter counter;
  counter.advance(500);
  EXPECT_EQ(counter.advance(3).skipped, 0U);
  EXPECT_EQ(counter.advance(4).sequence, 502U);
}

}  // namespace vibe::vision::sequence_counter_test
