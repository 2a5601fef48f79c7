#include "vibe_hardware/hid/hidraw_bus.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <string>

namespace vibe::hardware::hidraw_bus_test {
namespace {

TEST(HidrawBus, ListsDevicesOrSaysThatTheKernelHasNone) {
  HidrawBus bus;
  try {
    for (const HidInfo& info : bus.list()) EXPECT_EQ(info.path.rfind("/dev/hidraw", 0), 0U) << info.path;
    EXPECT_EQ(access("/sys/class/hidraw", F_OK), 0);
  } catch (const std::runtime_error& error) {
    EXPECT_NE(access("/sys/class/hidraw", F_OK), 0);
    EXPECT_NE(std::string(error.what()).find("pass the device in"), std::string::npos) << error.what();
  }
}

TEST(HidrawBus, ADeviceThatIsNotThereIsGone) {
  HidrawBus bus;
  EXPECT_THROW(bus.open("/dev/hidraw_none"), DeviceGone);
}

TEST(HidrawBus, WhatCannotBeOpenedIsNamed) {
  HidrawBus bus;
  try {
    bus.open("/dev/null");
    ADD_FAILURE() << "it was opened";
  } catch (const DeviceGone& gone) {
    EXPECT_STREQ(gone.what(), "/dev/null cannot be opened: Inappropriate ioctl for device");
  }
}

TEST(HidrawBus, WhatMayNotBeOpenedNamesTheUdevRule) {
  if (geteuid() == 0) GTEST_SKIP() << "root may open everything";
  char file[] = "/tmp/vibe_hidrawXXXXXX";
  const int descriptor = mkstemp(file);
  ASSERT_GE(descriptor, 0);
  fchmod(descriptor, 0);
  close(descriptor);
  HidrawBus bus;
  try {
    bus.open(file);
    ADD_FAILURE() << "it was opened";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("install the udev rule 60-vibe.rules"), std::string::npos) << error.what();
  }
  unlink(file);
}

TEST(HidrawBus, ListingIsCheap) {
  HidrawBus first, second;
  if (access("/sys/class/hidraw", F_OK) != 0) GTEST_SKIP() << "no hidraw";
  double least = 1;  // a busy machine makes any one of them slow
  for (int i = 0; i < 100; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    (i % 2 == 0 ? first : second).list();
    least = std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  std::printf("listing takes %.3f ms\n", 1e3 * least);
  EXPECT_LT(least, 5e-5);
}

}  // namespace
}  // namespace vibe::hardware::hidraw_bus_test
