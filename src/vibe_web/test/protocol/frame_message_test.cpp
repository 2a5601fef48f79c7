#include "protocol/frame_message.hpp"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

namespace vibe::web::frame_message_test {
namespace {

template <class T>
T at(const Bytes& bytes, std::size_t place) {
  T value;
  std::memcpy(&value, bytes.data() + place, sizeof value);
  return value;
}

TEST(FrameMessage, PlacesAreWithinHalfAStepOfTheBox) {
  std::vector<float> positions;
  for (int i = 0; i < 3 * 3618; ++i)
    positions.push_back(0.33F * static_cast<float>(std::sin(i * 0.7)) / (1 + static_cast<float>(i % 3)));
  FrameContent content;
  content.revision = 3;
  content.time = 12.5;
  content.joints = {1, 2, 3};
  const Bytes bytes = encodeFrame(content, positions);
  ASSERT_EQ(bytes.size(), 72 + 4 * 3 + 2 * positions.size());
  EXPECT_LT(60 * bytes.size(), 1'500'000U);  // a second of an organ of 3,618 particles
  EXPECT_EQ(at<std::uint32_t>(bytes, 4), 3U);
  EXPECT_EQ(at<double>(bytes, 8), 12.5);
  EXPECT_EQ(at<float>(bytes, 76), 2);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const float lowest = at<float>(bytes, 24 + 4 * (i % 3)), step = at<float>(bytes, 36 + 4 * (i % 3));
    const float back = lowest + step * static_cast<float>(at<std::uint16_t>(bytes, 84 + 2 * i));
    ASSERT_NEAR(back, positions[i], 0.51 * static_cast<double>(step)) << i;
  }
}

TEST(FrameMessage, FlatAndEmptyOrgansHaveNoSteps) {
  EXPECT_EQ(encodeFrame({}, {}).size(), 72U);
  const Bytes flat = encodeFrame({}, {0, 0, 1, 1, 0, 1});
  EXPECT_EQ(at<float>(flat, 40), 0);
  EXPECT_EQ(at<float>(flat, 32), 1);
  EXPECT_EQ(at<std::uint16_t>(flat, 72 + 2 * 3), 65535);
}

}  // namespace
}  // namespace vibe::web::frame_message_test
