#include "vibe_hardware/hid/report_descriptor.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "vibe_core/program/error.hpp"
#include "vibe_firmware/protocol/descriptors.hpp"

namespace vibe::hardware::report_descriptor_test {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Kind = ReportSize::Kind;

Bytes haptic() {
  return {std::begin(vibe_firmware::kHapticReportDescriptor), std::end(vibe_firmware::kHapticReportDescriptor)};
}
Bytes input() {
  return {std::begin(vibe_firmware::kInputReportDescriptor), std::end(vibe_firmware::kInputReportDescriptor)};
}

ReportLayout parse(const Bytes& bytes) {
  return parseReportDescriptor(bytes.data(), bytes.size());
}

template <class Function>
std::string errorOf(Function&& function) {
  try {
    function();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}
std::string parseError(const Bytes& bytes) {
  return errorOf([&] { parse(bytes); });
}
std::string checkError(const Bytes& bytes, DeviceKind kind) {
  return errorOf([&] { checkReportDescriptor(bytes.data(), bytes.size(), kind); });
}

TEST(ReportDescriptor, ReadsThoseOfTheFirmware) {
  const ReportLayout layout = parse(haptic());
  EXPECT_EQ(layout.usage_page, 1);
  EXPECT_EQ(layout.usage, 5);
  EXPECT_EQ(layout.sizeOf(Kind::Input, 1), vibe_firmware::kInputReportSize);
  EXPECT_EQ(layout.sizeOf(Kind::Feature, 2), vibe_firmware::kParameterReportSize);
  EXPECT_EQ(layout.sizeOf(Kind::Feature, 3), vibe_firmware::kStatusReportSize);
  EXPECT_EQ(layout.sizeOf(Kind::Feature, 5), vibe_firmware::kAxisReportSize);
  EXPECT_EQ(layout.sizeOf(Kind::Output, 1), 0U);
  EXPECT_EQ(layout.reports.size(), 5U);
  EXPECT_EQ(parse(input()).sizeOf(Kind::Feature, 2), 0U);
}

TEST(ReportDescriptor, PushPopAndLongItems) {
  const Bytes bytes{0x05, 1,  0x09, 5,    0xA1, 1,  // a gamepad
                    0x75, 8,  0x95, 2,    0xA4,     // 2 bytes, pushed
                    0x75, 16, 0x95, 3,    0xB4,     // 3 words, popped
                    0xFE, 2,  0x77, 0xC0, 0xC0,     // long item, ignored
                    0x81, 2,  0x95, 1,    0x91, 2, 0xC0};
  const ReportLayout layout = parse(bytes);
  EXPECT_EQ(layout.sizeOf(Kind::Input, 0), 2U);  // no id
  EXPECT_EQ(layout.sizeOf(Kind::Output, 0), 1U);
}

TEST(ReportDescriptor, EveryMistakeHasItsSentence) {
  EXPECT_EQ(parseError({}), "The report descriptor is empty; check the firmware of the device.");
  EXPECT_NE(parseError(Bytes(5000, 0)).find("has 5000 bytes, more than 4096"), std::string::npos);
  EXPECT_EQ(parseError({0x05}),
            "The report descriptor ends inside an item at byte 0; check the firmware of the device.");
  EXPECT_NE(parseError({0x05, 1, 0x27, 1, 2}).find("ends inside an item at byte 2"), std::string::npos);
  EXPECT_NE(parseError({0xFE, 9, 0, 1}).find("ends inside a long item"), std::string::npos);
  EXPECT_NE(parseError({0xC0}).find("ends a collection that was not begun"), std::string::npos);
  EXPECT_NE(parseError({0xA1, 1}).find("ends inside a collection"), std::string::npos);
  EXPECT_NE(parseError({0x85, 0}).find("has the report id 0"), std::string::npos);
  EXPECT_NE(parseError({0xB4}).find("pops what was not pushed"), std::string::npos);
  EXPECT_NE(parseError(Bytes(17, 0xA4)).find("pushes too often"), std::string::npos);
  EXPECT_NE(parseError({0x77, 255, 255, 255, 255, 0x97, 255, 255, 255, 255, 0x81, 2}).find("more than 4096 bytes"),
            std::string::npos);
  Bytes deep;
  for (int i = 0; i < 40; ++i) deep.insert(deep.end(), {0xA1, 0});
  EXPECT_NE(parseError(deep).find("nests collections too deeply"), std::string::npos);
}

TEST(ReportDescriptor, RecognisesTheDevicesOfThisRelease) {
  EXPECT_EQ(checkError(haptic(), DeviceKind::Haptic), "no error");
  EXPECT_EQ(checkError(input(), DeviceKind::Input), "no error");
  EXPECT_EQ(checkError(haptic(), DeviceKind::Input), "no error");  // it has all that an input device needs
  EXPECT_EQ(checkError(input(), DeviceKind::Haptic),
            "It is not a haptic device of this release: its parameter report (id 2) has 0 bytes instead of 43; select "
            "another device by its serial number in the calibration, or, if its firmware is of another release, "
            "install that of "
            "this one.");
  const Bytes mouse{0x05, 1, 0x09, 2, 0xA1, 1, 0x75, 8, 0x95, 3, 0x81, 2, 0xC0};
  EXPECT_NE(checkError(mouse, DeviceKind::Haptic).find("has usage 2 of page 1, not a gamepad's 5 of 1"),
            std::string::npos);
}

TEST(ReportDescriptor, DamagedDescriptorsAreErrorsOrHarmless) {
  std::mt19937 random(1);
  const Bytes good = haptic();
  int errors = 0;
  for (int i = 0; i < 20000; ++i) {
    Bytes bytes = good;
    for (int k = random() % 4; k >= 0; --k) bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    bytes.resize(random() % (bytes.size() + 1));
    errors += checkError(bytes, DeviceKind::Haptic) != "no error" ? 1 : 0;
  }
  EXPECT_GT(errors, 15000);
}

}  // namespace
}  // namespace vibe::hardware::report_descriptor_test
