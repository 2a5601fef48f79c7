#include "vibe_firmware/protocol/descriptors.hpp"

#include <gtest/gtest.h>

#include "protocol/hid_items.hpp"

namespace vibe_firmware::descriptors_test {
namespace {

HidItems haptic() {
  return {kHapticReportDescriptor.data(), sizeof kHapticReportDescriptor};
}
HidItems input() {
  return {kInputReportDescriptor.data(), sizeof kInputReportDescriptor};
}

TEST(ReportDescriptors, DeclareTheSizesThatArePacked) {
  for (const HidItems& items : {haptic(), input()}) {
    EXPECT_EQ(items.size('i', kInputReportId), kInputReportSize);
    EXPECT_EQ(items.size('f', kStatusReportId), kStatusReportSize);
    EXPECT_EQ(items.size('f', kAxisReportId), kAxisReportSize);
    EXPECT_EQ(items.size('f', kAxisReportId + 1), kAxisReportSize);
  }
  EXPECT_EQ(haptic().size('f', kParameterReportId), kParameterReportSize);
  EXPECT_EQ(haptic().reports().size(), 5U);
  EXPECT_EQ(input().reports().size(), 4U);
}

TEST(ReportDescriptors, AreGamepadsWithTwoAxesAndSixteenButtons) {
  for (const HidItems& items : {haptic(), input()}) {
    EXPECT_TRUE(items.collections().count({0x01, 0x05}));  // generic desktop, game pad
    const std::vector<HidField>& fields = items.reports().at({'i', kInputReportId});
    ASSERT_EQ(fields.size(), 3U);
    EXPECT_EQ(fields[0].usage_page, 0x01U);
    EXPECT_EQ(fields[0].usages, (std::vector<std::uint32_t>{0x30, 0x31}));  // X, Y
    EXPECT_EQ(fields[0].bits, 16U);
    EXPECT_EQ(fields[0].count, 2U);
    EXPECT_EQ(fields[0].logical_minimum, -32767);
    EXPECT_EQ(fields[0].logical_maximum, 32767);
    EXPECT_EQ(fields[0].flags, 2U);  // data, variable, absolute
    EXPECT_EQ(fields[1].usage_page, 0x09U);
    EXPECT_EQ(fields[1].usages.size(), 16U);
    EXPECT_EQ(fields[1].bits * fields[1].count, 16U);
    EXPECT_EQ(fields[2].usage_page, 0xFF00U) << "gamepad drivers must ignore the rest";
  }
}

// A gamepad driver reads axes and buttons at the offsets of the descriptor: they must be where pack() puts them.
TEST(ReportDescriptors, AxesAndButtonsLieWhereTheyArePacked) {
  InputReport report;
  report.axes = {0x1234, -2};
  report.buttons = 0xA55A;
  std::uint8_t bytes[kInputReportSize];
  pack(report, bytes);
  EXPECT_EQ(bytes[1] | bytes[2] << 8, 0x1234);
  EXPECT_EQ(bytes[3] | bytes[4] << 8, 0xFFFE);
  EXPECT_EQ(bytes[5] | bytes[6] << 8, 0xA55A);
}

TEST(ReportDescriptors, ReaderOfTheTestRejectsDamagedOnes) {
  EXPECT_THROW(HidItems(kHapticReportDescriptor.data(), sizeof kHapticReportDescriptor - 1), std::runtime_error);
  const std::uint8_t cut[] = {0x26, 0xFF};
  EXPECT_THROW(HidItems(cut, sizeof cut), std::runtime_error);
}

TEST(ConfigurationDescriptor, IsAChainOfItsParts) {
  const auto bytes = configurationDescriptor(300);
  std::vector<std::uint8_t> types;
  std::size_t i = 0;
  for (; i < bytes.size(); i += bytes[i]) {
    ASSERT_GT(bytes[i], 0);
    types.push_back(bytes[i + 1]);
  }
  EXPECT_EQ(i, bytes.size());
  EXPECT_EQ(types, (std::vector<std::uint8_t>{2, 4, 0x21, 5}));
  EXPECT_EQ(bytes[2] | bytes[3] << 8, static_cast<int>(bytes.size()));
  EXPECT_EQ(bytes[25] | bytes[26] << 8, 300);  // length of the report descriptor in the HID descriptor
  EXPECT_EQ(bytes[29], 0x81);                  // interrupt endpoint to the host
  EXPECT_EQ(bytes[30], 3);
  EXPECT_GE(bytes[31] | bytes[32] << 8, static_cast<int>(kInputReportSize));
}

TEST(DeviceDescriptor, TellsTheDevicesApart) {
  const auto haptic_device = deviceDescriptor(kHapticProductId), input_device = deviceDescriptor(kInputProductId);
  EXPECT_EQ(haptic_device[0], haptic_device.size());
  EXPECT_EQ(haptic_device[1], 1);
  EXPECT_EQ(haptic_device[7], 64);  // packet size of endpoint 0
  EXPECT_EQ(haptic_device[17], 1);  // one configuration
  EXPECT_NE(haptic_device[10] | haptic_device[11] << 8, input_device[10] | input_device[11] << 8);
}

}  // namespace
}  // namespace vibe_firmware::descriptors_test
