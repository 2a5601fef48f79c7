#include "camera/pixels.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace vibe::vision::pixel_format_test {

namespace {

std::vector<int> greyOf(PixelFormat format, const std::vector<std::uint8_t>& data, int width, int height) {
  EXPECT_EQ(sizeOf(format, width, height), data.size()) << nameOf(format);
  std::vector<std::uint8_t> grey(static_cast<std::size_t>(width * height));
  toMono8(format, data.data(), width, height, grey.data());
  return {grey.begin(), grey.end()};
}

/// Bits of the values in a row, least significant first.
std::vector<std::uint8_t> asStream(const std::vector<unsigned>& values, unsigned bits) {
  std::vector<std::uint8_t> bytes((values.size() * bits + 7) / 8);
  for (std::size_t i = 0; i < values.size() * bits; ++i) {
    const unsigned bit = values[i / bits] >> (i % bits) & 1U;
    bytes[i / 8] = static_cast<std::uint8_t>(bytes[i / 8] | bit << (i % 8));
  }
  return bytes;
}

using Values = std::vector<int>;

}  // namespace

TEST(PixelFormat, Mono8IsCopied) {
  EXPECT_EQ(greyOf(PixelFormat::Mono8, {1, 2, 3, 255}, 2, 2), (Values{1, 2, 3, 255}));
}

TEST(PixelFormat, WordsKeepTheirUpperEightBits) {
  EXPECT_EQ(greyOf(PixelFormat::Mono10, {0xFF, 0x03, 0x04, 0x00, 0x03, 0x00}, 3, 1), (Values{255, 1, 0}));
  EXPECT_EQ(greyOf(PixelFormat::Mono12, {0xFF, 0x0F, 0x10, 0x00, 0x0F, 0x00}, 3, 1), (Values{255, 1, 0}));
  EXPECT_EQ(greyOf(PixelFormat::Mono16, {0xFF, 0xAB, 0x00, 0x01}, 2, 1), (Values{0xAB, 1}));
}

TEST(PixelFormat, PackedPixelsHaveTheirUpperBitsInTheOuterBytes) {
  EXPECT_EQ(greyOf(PixelFormat::Mono12Packed, {0x12, 0xF5, 0x34, 0x56, 0x0F}, 3, 1), (Values{0x12, 0x34, 0x56}));
  EXPECT_EQ(greyOf(PixelFormat::Mono10Packed, {0x12, 0x33, 0x34}, 2, 1), (Values{0x12, 0x34}));
}

TEST(PixelFormat, StreamsOfBitsAreReadFromTheLeastSignificant) {
  const std::vector<unsigned> ten{1023, 0, 512, 4, 700, 3, 77}, twelve{4095, 0, 2048, 16, 3000, 15, 999};
  EXPECT_EQ(greyOf(PixelFormat::Mono10p, asStream(ten, 10), 7, 1), (Values{255, 0, 128, 1, 175, 0, 19}));
  EXPECT_EQ(greyOf(PixelFormat::Mono12p, asStream(twelve, 12), 7, 1), (Values{255, 0, 128, 1, 187, 0, 62}));
}

TEST(PixelFormat, ColoursAreWeighted) {
  EXPECT_EQ(greyOf(PixelFormat::RGB8, {200, 0, 0, 0, 0, 200}, 2, 1), (Values{60, 23}));
  EXPECT_EQ(greyOf(PixelFormat::BGR8, {200, 0, 0, 0, 0, 200}, 2, 1), (Values{23, 60}));
  EXPECT_EQ(greyOf(PixelFormat::YUYV, {10, 99, 20, 99}, 2, 1), (Values{10, 20}));
  EXPECT_EQ(greyOf(PixelFormat::UYVY, {99, 10, 99, 20}, 2, 1), (Values{10, 20}));
}

TEST(PixelFormat, ARedSceneIsRedInEveryBayerPattern) {
  const struct {
    PixelFormat format;
    int x, y;  // where red is
  } cases[] = {{PixelFormat::BayerRG8, 0, 0},
               {PixelFormat::BayerGR8, 1, 0},
               {PixelFormat::BayerGB8, 0, 1},
               {PixelFormat::BayerBG8, 1, 1}};
  for (const auto& c : cases) {
    std::vector<std::uint8_t> data(64, 0);
    for (int y = c.y; y < 8; y += 2) {
      for (int x = c.x; x < 8; x += 2) data[static_cast<std::size_t>(8 * y + x)] = 200;
    }
    const Values grey = greyOf(c.format, data, 8, 8);
    for (int y = 2; y < 6; ++y) {
      for (int x = 2; x < 6; ++x) EXPECT_NEAR(grey[static_cast<std::size_t>(8 * y + x)], 60, 1) << nameOf(c.format);
    }
  }
}

TEST(PixelFormat, AWhiteEdgeStaysWhereItIsInABayerPattern) {
  std::vector<std::uint8_t> data(16 * 16, 0);
  for (std::size_t y = 0; y < 16; ++y) {
    for (std::size_t x = 8; x < 16; ++x) data[16 * y + x] = 200;
  }
  const Values grey = greyOf(PixelFormat::BayerRG8, data, 16, 16);
  for (std::size_t y = 2; y < 14; y += 2) {
    double darkness = 0;  // of two rows, so that each colour is there once; an edge at 8 gives 8
    for (std::size_t x = 0; x < 16; ++x) darkness += 1 - (grey[16 * y + x] + grey[16 * y + 16 + x]) / 400.0;
    EXPECT_NEAR(darkness, 8, 0.12);
  }
}

TEST(PixelFormat, AnUnknownCodeIsNamedAndNotRead) {
  const auto unknown = static_cast<PixelFormat>(0x01080099);
  EXPECT_FALSE(isReadable(unknown));
  EXPECT_EQ(nameOf(unknown), "0x01080099");
  EXPECT_EQ(sizeOf(unknown, 4, 4), 0U);
  EXPECT_TRUE(isReadable(PixelFormat::Mono12p));
  EXPECT_EQ(sizeOf(PixelFormat::Mono8, -1, 4), 0U);
}

}  // namespace vibe::vision::pixel_format_test
