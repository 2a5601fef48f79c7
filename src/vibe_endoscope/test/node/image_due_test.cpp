#include "image_due.hpp"

#include <gtest/gtest.h>

namespace vibe::endoscope::image_due_test {
namespace {

int imagesOf(ImageDue& due, double begin, double rate, int states) {
  int images = 0;
  for (int k = 0; k < states; ++k) images += due.isDue(ros::Time(begin + k / rate));
  return images;
}

TEST(ImageDue, EveryStateWithoutARate) {
  ImageDue due(0);
  EXPECT_EQ(imagesOf(due, 1, 60, 60), 60);
}

TEST(ImageDue, MeanRateIsRightEvenIfStatesAreNotAMultiple) {
  for (const double rate : {10., 20., 25., 30., 50.}) {
    ImageDue due(rate);
    EXPECT_NEAR(imagesOf(due, 1, 60, 600), 10 * rate, 1) << rate;
  }
}

TEST(ImageDue, NoMoreImagesThanStatesAndNoBurstAfterAGap) {
  ImageDue due(30);
  EXPECT_EQ(imagesOf(due, 1, 10, 10), 10);
  EXPECT_EQ(imagesOf(due, 100, 60, 60), 30);
}

TEST(ImageDue, ContinuesAfterTimeWasSetBack) {
  ImageDue due(30);
  EXPECT_TRUE(due.isDue(ros::Time(100)));
  EXPECT_TRUE(due.isDue(ros::Time(1)));
  EXPECT_FALSE(due.isDue(ros::Time(1.01)));
}

}  // namespace
}  // namespace vibe::endoscope::image_due_test
