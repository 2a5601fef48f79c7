#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "vibe_firmware/protocol/descriptors.hpp"
#include "vibe_hardware/driver/calibration.hpp"

namespace vibe::hardware::udev_rule_test {
namespace {

std::vector<std::string> deviceRules() {
  std::ifstream file("../udev/60-vibe.rules");
  std::vector<std::string> rules;
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("KERNEL==", 0) == 0) rules.push_back(line);
  }
  return rules;
}

std::string attribute(const char* name, std::uint16_t id) {
  char text[60];
  std::snprintf(text, sizeof text, "ATTRS{%s}==\"%04x\"", name, id);
  return text;
}

TEST(UdevRule, NamesTheIdsOfTheDescriptors) {
  const std::vector<std::string> rules = deviceRules();
  ASSERT_EQ(rules.size(), 2U);
  const std::uint16_t products[] = {vibe_firmware::kHapticProductId, vibe_firmware::kInputProductId};
  for (std::size_t i = 0; i < rules.size(); ++i) {
    EXPECT_NE(rules[i].find(attribute("idVendor", vibe_firmware::kVendorId)), std::string::npos) << rules[i];
    EXPECT_NE(rules[i].find(attribute("idProduct", products[i])), std::string::npos) << rules[i];
  }
}

TEST(UdevRule, GivesAccessWithoutRootButNotToEverybody) {
  for (const std::string& rule : deviceRules()) {
    for (const char* part :
         {"KERNEL==\"hidraw*\"", "MODE=\"0660\"", "GROUP=\"plugdev\"", "TAG+=\"uaccess\"", "SYMLINK+="}) {
      EXPECT_NE(rule.find(part), std::string::npos) << part << " in " << rule;
    }
  }
}

TEST(UdevRule, TheShippedCalibrationLooksForTheSameDevices) {
  const Calibration calibration = Calibration::load("../config/devices.yaml");
  for (const DeviceSelection& device : calibration.devices) EXPECT_EQ(device.vendor, vibe_firmware::kVendorId);
  EXPECT_EQ(calibration.devices[0].product, vibe_firmware::kHapticProductId);
  EXPECT_EQ(calibration.devices[1].product, vibe_firmware::kInputProductId);
}

}  // namespace
}  // namespace vibe::hardware::udev_rule_test
