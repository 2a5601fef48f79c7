#include "vibe_example_input_device/device_stream.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace vibe_example {
namespace {

using Bytes = std::vector<std::uint8_t>;

// 0.25 m inserted, rotated by -1 rad, tip 0.5 rad up, 0 to the side, helix grab (bit 1) pressed.
Bytes frame(int sequence) {
  Bytes bytes = {0xA5, static_cast<std::uint8_t>(sequence), 0xC4, 0x09, 0xF0, 0xD8, 0x88, 0x13, 0, 0, 0x02};
  bytes.push_back(crc8(bytes.data(), bytes.size()));
  return bytes;
}

Bytes recording(const std::vector<int>& sequence) {
  Bytes bytes;
  for (const int number : sequence) {
    const Bytes next = frame(number);
    bytes.insert(bytes.end(), next.begin(), next.end());
  }
  return bytes;
}

std::vector<std::int64_t> numbersOf(DeviceStream& stream, const Bytes& bytes) {
  std::vector<std::int64_t> numbers;
  for (const DeviceSample& sample : stream.read(bytes.data(), bytes.size())) numbers.push_back(sample.number);
  return numbers;
}

using Numbers = std::vector<std::int64_t>;

TEST(DeviceStream, ChecksumIsThatOfTheStandard) {
  const std::string digits = "123456789";
  EXPECT_EQ(crc8(reinterpret_cast<const std::uint8_t*>(digits.data()), digits.size()), 0xF4);
}

TEST(DeviceStream, GoodFrameIsReadInSiUnits) {
  DeviceStream stream;
  const Bytes bytes = frame(9);
  const std::vector<DeviceSample> samples = stream.read(bytes.data(), bytes.size());
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_EQ(samples[0].number, 0);
  EXPECT_DOUBLE_EQ(samples[0].joints[0], 0.25);
  EXPECT_DOUBLE_EQ(samples[0].joints[1], -1);
  EXPECT_DOUBLE_EQ(samples[0].joints[2], 0.5);
  EXPECT_DOUBLE_EQ(samples[0].joints[3], 0);
  EXPECT_EQ(samples[0].buttons, (std::array<bool, 6>{false, true, false, false, false, false}));
}

TEST(DeviceStream, BytesMayArriveInPiecesOfAnySize) {
  const Bytes bytes = recording({254, 255, 0, 1});  // the sequence number wraps
  for (std::size_t piece = 1; piece <= bytes.size(); ++piece) {
    DeviceStream stream;
    Numbers numbers;
    for (std::size_t i = 0; i < bytes.size(); i += piece)
      for (const DeviceSample& sample : stream.read(&bytes[i], std::min(piece, bytes.size() - i)))
        numbers.push_back(sample.number);
    ASSERT_EQ(numbers, (Numbers{0, 1, 2, 3})) << piece;
    ASSERT_EQ(stream.skippedBytes() + stream.lostFrames() + stream.droppedFrames(), 0u) << piece;
  }
}

TEST(DeviceStream, TruncatedFrameIsLostAndTheNextOneIsFound) {
  Bytes bytes = recording({0, 1, 2});
  bytes.erase(bytes.begin() + 15, bytes.begin() + 20);  // of frame 1 remain 7 bytes
  DeviceStream stream;
  EXPECT_EQ(numbersOf(stream, bytes), (Numbers{0, 2}));
  EXPECT_EQ(stream.skippedBytes(), 7u);
  EXPECT_EQ(stream.lostFrames(), 1u);
}

TEST(DeviceStream, ReorderedAndRepeatedFramesAreDropped) {
  DeviceStream stream;
  EXPECT_EQ(numbersOf(stream, recording({0, 2, 1, 2, 3})), (Numbers{0, 2, 3}));
  EXPECT_EQ(stream.droppedFrames(), 2u);
  EXPECT_EQ(stream.lostFrames(), 1u);  // frame 1 came too late to be used
  EXPECT_EQ(stream.skippedBytes(), 0u);
}

TEST(DeviceStream, AnyWrongBitMakesAFrameCorrupt) {
  for (std::size_t bit = 0; bit < 8 * 12; ++bit) {
    Bytes bytes = recording({0, 1, 2});
    bytes[12 + bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    DeviceStream stream;
    ASSERT_EQ(numbersOf(stream, bytes), (Numbers{0, 2})) << "bit " << bit;
    ASSERT_EQ(stream.skippedBytes(), 12u) << "bit " << bit;
  }
}

}  // namespace
}  // namespace vibe_example
