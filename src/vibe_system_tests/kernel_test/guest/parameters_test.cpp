// Feature reports through the kernel: what is written is what is read back.

#include <gtest/gtest.h>

#include <cerrno>
#include <random>

#include "plugged_device.hpp"
#include "statistics.hpp"
#include "vibe_firmware/protocol/reports.hpp"

namespace vibe::hardware {
namespace {

using namespace vibe_firmware;
using Bytes = std::vector<std::uint8_t>;

template <class Report>
Bytes packed(const Report& report) {
  std::uint8_t bytes[kParameterReportSize];
  const std::size_t size = pack(report, bytes);
  return {bytes, bytes + size};
}

/// Sets that the device accepts, each different from the others.
class Sets {
 public:
  ParameterReport next() {
    ParameterReport set;
    set.number = ++number_;
    for (AxisParameters& axis : set.axes) {
      axis.stiffness = draw(0, 0.1F);
      axis.damping = draw(0, 5e-4F);
      axis.position = draw(-1, 1);
      axis.torque = draw(-0.005F, 0.005F);
      axis.torque_limit = draw(0.01F, 0.02F);
    }
    return set;
  }

 private:
  float draw(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }

  std::mt19937 random_{1};
  std::uint16_t number_ = 0;
};

StatusReport statusOf(HidrawFile& file) {
  StatusReport status;
  const Bytes bytes = file.getFeature(kStatusReportId);
  EXPECT_TRUE(unpack(bytes.data(), bytes.size(), status)) << bytes.size() << " bytes";
  return status;
}

struct Result {
  int same = 0, different = 0, refused = 0;
  std::vector<double> set_times, get_times;
};

/// Writes sets and reads each back.
Result writeAndReadBack(HidrawFile& file, Sets& sets, int count) {
  Result result;
  for (int i = 0; i < count; ++i) {
    const Bytes written = packed(sets.next());
    const double start = now();
    const int error = file.setFeature(written);
    const double middle = now();
    const Bytes read = file.getFeature(kParameterReportId);
    result.set_times.push_back(middle - start);
    result.get_times.push_back(now() - middle);
    if (error) {
      ++result.refused;
    } else {
      ++(read == written ? result.same : result.different);
    }
  }
  return result;
}

void hundredOfHundred(PluggedDevice& device, const std::string& label) {
  HidrawFile file(device.plug().hidraw);
  const StatusReport before = statusOf(file);
  Sets sets;
  const Result result = writeAndReadBack(file, sets, 100);
  EXPECT_EQ(result.same, 100);
  EXPECT_EQ(result.refused, 0);
  const StatusReport after = statusOf(file);
  EXPECT_EQ(after.accepted - before.accepted, 100U);
  EXPECT_EQ(after.refused, before.refused);
  EXPECT_EQ(after.parameter_number, 100);
  figures("SET_REPORT" + label, result.set_times);
  figures("GET_REPORT" + label, result.get_times);
}

TEST(Parameters, HundredOfHundredWritesReadBack) {
  hundredOfHundred(hapticDevice(), "");
}

TEST(Parameters, HundredOfHundredWritesToTheImageReadBack) {
  if (!imageRuns()) GTEST_SKIP() << "there is no firmware image; scripts/firmware builds it";
  hundredOfHundred(imageDevice(), " of the firmware image");
}

TEST(Parameters, AWrongReadBackIsNoticed) {
  HidrawFile file(hapticDevice().plug().hidraw);
  Sets sets;
  tellBridge("corrupt haptic 3");
  const Result result = writeAndReadBack(file, sets, 20);
  EXPECT_EQ(result.different, 3);
  EXPECT_EQ(result.same, 17);
}

TEST(Parameters, ASetThatIsNotPassiveIsRefusedAndTheOldOneStays) {
  HidrawFile file(hapticDevice().plug().hidraw);
  Sets sets;
  const Bytes good = packed(sets.next());
  ASSERT_EQ(file.setFeature(good), 0);
  ParameterReport stiff = sets.next();
  stiff.axes[1].stiffness = 1000;
  EXPECT_EQ(file.setFeature(packed(stiff)), 0);
  EXPECT_EQ(file.getFeature(kParameterReportId), good);
  const StatusReport status = statusOf(file);
  EXPECT_EQ(status.refused_number, stiff.number);
  EXPECT_EQ(status.refusal.refusal, Refusal::ViscousFriction);
  EXPECT_EQ(status.refusal.axis, 1);
  EXPECT_GT(status.refusal.value, 0);
  EXPECT_TRUE(status.flags & kRefused);
}

TEST(Parameters, AReportOfTheWrongLengthOrWithoutMeaningIsAnError) {
  HidrawFile file(hapticDevice().plug().hidraw);
  Sets sets;
  const Bytes good = packed(sets.next());
  ASSERT_EQ(file.setFeature(good), 0);
  Bytes shorter = packed(sets.next());
  shorter.pop_back();
  EXPECT_EQ(file.setFeature(shorter), EPIPE);  // the device stalls
  EXPECT_EQ(file.setFeature({99, 1, 2}), EPIPE);
  EXPECT_TRUE(file.getFeature(99).empty());
  EXPECT_EQ(file.getFeature(kParameterReportId), good);
}

TEST(Parameters, TheInputDeviceHasNone) {
  HidrawFile file(inputDevice().plug().hidraw);
  Sets sets;
  EXPECT_EQ(file.setFeature(packed(sets.next())), EPIPE);
  EXPECT_TRUE(file.getFeature(kParameterReportId).empty());
  statusOf(file);
}

}  // namespace
}  // namespace vibe::hardware
