#include "vibe_firmware/protocol/reports.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <vector>

namespace vibe_firmware::reports_test {
namespace {

using ByteVector = std::vector<std::uint8_t>;

template <std::size_t kSize, typename Report>
ByteVector packed(const Report& report) {
  std::uint8_t bytes[kSize];
  EXPECT_EQ(pack(report, bytes), kSize);
  return {bytes, bytes + kSize};
}

template <typename Report>
bool unpacked(const ByteVector& bytes, Report& report) {
  return unpack(bytes.data(), bytes.size(), report);
}

// The layout is a contract with other programs: these bytes may only change together with kProtocolVersion.
TEST(Reports, InputReportHasFixedBytes) {
  InputReport report;
  report.axes = {0x0102, -2};
  report.buttons = 0x8001;
  report.sequence = 0xFFFE;
  report.time_us = 0x01020304;
  report.counts = {-1, 0x00010203};
  report.torque = {-2900, 2900};
  report.flags = kHostSilent | kIndexed1;
  report.parameter_number = 0x0708;
  const ByteVector expected = {1,    0x02, 0x01, 0xFE, 0xFF, 0x01, 0x80, 0xFE, 0xFF, 0x04, 0x03, 0x02, 0x01, 0xFF,
                               0xFF, 0xFF, 0xFF, 0x03, 0x02, 0x01, 0x00, 0xAC, 0xF4, 0x54, 0x0B, 0x21, 0x08, 0x07};
  EXPECT_EQ(packed<kInputReportSize>(report), expected);
  InputReport back;
  ASSERT_TRUE(unpacked(expected, back));
  EXPECT_EQ(packed<kInputReportSize>(back), expected);
  EXPECT_EQ(back.counts[0], -1);
  EXPECT_EQ(back.torque[0], -2900);
}

TEST(Reports, ParameterReportHasFixedBytes) {
  ParameterReport report;
  report.number = 0x0201;
  report.axes[0] = {1, -2, 0.5F, 0, 8};
  report.axes[1].torque_limit = 1;
  ByteVector expected = {2, 0x01, 0x02, 0, 0, 0x80, 0x3F, 0, 0, 0, 0xC0, 0, 0, 0, 0x3F, 0, 0, 0, 0, 0, 0, 0, 0x41};
  expected.resize(kParameterReportSize - 4, 0);
  expected.insert(expected.end(), {0x00, 0x00, 0x80, 0x3F});
  EXPECT_EQ(packed<kParameterReportSize>(report), expected);
}

TEST(Reports, StatusReportHasFixedBytes) {
  StatusReport report;
  report.version = {1, 2, 3};
  report.flags = kRefused;
  report.parameter_number = 0x0405;
  report.refused_number = 0x0607;
  report.refusal = {Refusal::CoulombFriction, 1, 1, 2};
  report.accepted = 8;
  report.refused = 0x09000000;
  report.late_ticks = 10;
  const ByteVector expected = {3,    kProtocolVersion,
                               1,    2,
                               3,    8,
                               0x05, 0x04,
                               0x07, 0x06,
                               5,    1,
                               0,    0,
                               0x80, 0x3F,
                               0,    0,
                               0,    0x40,
                               8,    0,
                               0,    0,
                               0,    0,
                               0,    9,
                               10,   0,
                               0,    0};
  EXPECT_EQ(packed<kStatusReportSize>(report), expected);
  StatusReport back;
  ASSERT_TRUE(unpacked(expected, back));
  EXPECT_EQ(back.refusal.refusal, Refusal::CoulombFriction);
  EXPECT_EQ(packed<kStatusReportSize>(back), expected);
}

TEST(Reports, AxisReportContainsEveryFieldOfTheConfiguration) {
  AxisReport report;
  report.axis = 1;
  auto* fields = reinterpret_cast<unsigned char*>(&report.config);
  for (std::size_t i = 0; i < kAxisConfigFields; ++i) {
    const auto value = static_cast<float>(i + 1);
    std::memcpy(fields + i * sizeof value, &value, sizeof value);
  }
  const ByteVector bytes = packed<kAxisReportSize>(report);
  EXPECT_EQ(bytes[0], kAxisReportId + 1);
  for (std::size_t i = 0; i < kAxisConfigFields; ++i) {
    float value = 0;
    std::memcpy(&value, &bytes[1 + 4 * i], sizeof value);  // both little-endian
    EXPECT_EQ(value, static_cast<float>(i + 1)) << "field " << i;
  }
  AxisReport back;
  ASSERT_TRUE(unpacked(bytes, back));
  EXPECT_EQ(back.axis, 1);
  EXPECT_EQ(back.config.counts_per_turn, static_cast<float>(kAxisConfigFields));
}

TEST(Reports, OtherSizesAndIdsAreRejectedAndChangeNothing) {
  ParameterReport target;
  target.number = 77;
  const ByteVector good = packed<kParameterReportSize>(ParameterReport{});
  for (const int change : {-43, -42, -1, 1, 21}) {
    ByteVector bytes = good;
    bytes.resize(static_cast<std::size_t>(static_cast<int>(good.size()) + change), 0);
    EXPECT_FALSE(unpacked(bytes, target)) << "size " << bytes.size();
  }
  ByteVector other = good;
  other[0] = kStatusReportId;
  EXPECT_FALSE(unpacked(other, target));
  EXPECT_FALSE(unpack(nullptr, kParameterReportSize, target));
  EXPECT_EQ(target.number, 77);
  EXPECT_TRUE(unpacked(good, target));
  EXPECT_EQ(target.number, 0);
}

TEST(Reports, NotANumberTravelsUnchanged) {
  ParameterReport report;
  report.axes[1].damping = std::numeric_limits<float>::quiet_NaN();
  const ByteVector bytes = packed<kParameterReportSize>(report);
  ParameterReport back;
  ASSERT_TRUE(unpacked(bytes, back));
  EXPECT_EQ(packed<kParameterReportSize>(back), bytes);
}

}  // namespace
}  // namespace vibe_firmware::reports_test
