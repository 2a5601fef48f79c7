#include "vibe_firmware/protocol/control_endpoint.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "vibe_firmware/protocol/descriptors.hpp"
#include "vibe_firmware/protocol/haptic_function.hpp"
#include "vibe_firmware/protocol/input_function.hpp"

namespace vibe_firmware::control_endpoint_test {
namespace {

using ByteVector = std::vector<std::uint8_t>;

class Endpoint : public ::testing::Test {
 protected:
  /// A request to the host. @return its answer; nothing more than {0xEE} if it was stalled
  ByteVector get(std::uint8_t type, std::uint8_t request, std::uint16_t value, std::uint16_t length = 255,
                 std::uint16_t index = 0) {
    ByteVector response(512, 0xAA);
    const int size = endpoint_.handle({type, request, value, index, length}, nullptr, response.data(), response.size());
    if (size == ControlEndpoint::kStall) return {0xEE};
    response.resize(static_cast<std::size_t>(size));
    return response;
  }

  /// A request from the host. @return whether it was taken
  bool set(std::uint8_t type, std::uint8_t request, std::uint16_t value, const ByteVector& data = {},
           std::uint16_t index = 0) {
    const auto length = static_cast<std::uint16_t>(data.size());
    return endpoint_.handle({type, request, value, index, length}, data.data(), nullptr, 0) == 0;
  }

  HapticFunction function_{HapticConfig{}, "A12"};
  ControlEndpoint endpoint_{function_};
};

const ByteVector kStalled = {0xEE};

TEST_F(Endpoint, GivesTheDescriptors) {
  const ByteVector device = get(0x80, 6, 0x0100);
  ASSERT_EQ(device.size(), 18U);
  EXPECT_EQ(device[8] | device[9] << 8, kVendorId);
  EXPECT_EQ(device[10] | device[11] << 8, kHapticProductId);
  EXPECT_EQ(get(0x80, 6, 0x0200).size(), kConfigurationSize);
  EXPECT_EQ(get(0x81, 6, 0x2200).size(), sizeof kHapticReportDescriptor);
  const ByteVector hid = get(0x81, 6, 0x2100);
  ASSERT_EQ(hid.size(), 9U);
  EXPECT_EQ(hid[7] | hid[8] << 8, static_cast<int>(sizeof kHapticReportDescriptor));
  EXPECT_EQ(get(0x80, 6, 0x0600), kStalled);  // device qualifier: full speed only
}

TEST_F(Endpoint, GivesStringsInUtf16) {
  EXPECT_EQ(get(0x80, 6, 0x0300), (ByteVector{4, 3, 0x09, 0x04}));
  EXPECT_EQ(get(0x80, 6, 0x0303, 255, 0x0409), (ByteVector{8, 3, 'A', 0, '1', 0, '2', 0}));
  EXPECT_EQ(get(0x80, 6, 0x0301).size(), 2 + 2 * std::string("ViBE").size());
  EXPECT_EQ(get(0x80, 6, 0x0304), kStalled);
}

TEST_F(Endpoint, GivesNoMoreThanAskedFor) {
  EXPECT_EQ(get(0x80, 6, 0x0100, 8).size(), 8U);
  EXPECT_EQ(get(0x80, 6, 0x0303, 2), (ByteVector{8, 3}));
  std::uint8_t small[4];
  EXPECT_EQ(endpoint_.handle({0x80, 6, 0x0200, 0, 255}, nullptr, small, sizeof small), 4);
}

TEST_F(Endpoint, IsConfiguredOnRequest) {
  EXPECT_EQ(get(0x80, 8, 0, 1), ByteVector{0});
  EXPECT_FALSE(set(0x00, 9, 2));
  EXPECT_FALSE(endpoint_.configured());
  EXPECT_TRUE(set(0x00, 9, 1));
  EXPECT_TRUE(endpoint_.configured());
  EXPECT_EQ(get(0x80, 8, 0, 1), ByteVector{1});
  EXPECT_EQ(get(0x81, 10, 0, 1), ByteVector{0});
  EXPECT_TRUE(set(0x01, 11, 0));
  EXPECT_FALSE(set(0x01, 11, 1));
  endpoint_.reset();
  EXPECT_FALSE(endpoint_.configured());
  EXPECT_EQ(get(0x81, 10, 0, 1), kStalled);
}

TEST_F(Endpoint, InterruptEndpointIsHaltedAndReleased) {
  EXPECT_FALSE(set(0x02, 3, 0, {}, 0x81));  // not configured yet
  set(0x00, 9, 1);
  EXPECT_TRUE(set(0x02, 3, 0, {}, 0x81));
  EXPECT_TRUE(endpoint_.halted());
  EXPECT_EQ(get(0x82, 0, 0, 2, 0x81), (ByteVector{1, 0}));
  EXPECT_TRUE(set(0x02, 1, 0, {}, 0x81));
  EXPECT_FALSE(endpoint_.halted());
  EXPECT_EQ(get(0x82, 0, 0, 2, 0x81), (ByteVector{0, 0}));
  set(0x02, 3, 0, {}, 0x81);
  EXPECT_TRUE(set(0x01, 11, 0));  // selecting the interface releases it too
  EXPECT_FALSE(endpoint_.halted());
  EXPECT_FALSE(set(0x02, 3, 1, {}, 0x81));  // there is no such feature
  EXPECT_FALSE(set(0x02, 3, 0, {}, 0x82));  // there is no such endpoint
}

TEST_F(Endpoint, ParametersAreSetAndReadBack) {
  ParameterReport parameters;
  parameters.number = 9;
  parameters.axes[1].stiffness = 0.25F;
  std::uint8_t bytes[kParameterReportSize];
  pack(parameters, bytes);
  const ByteVector data(bytes, bytes + sizeof bytes);
  EXPECT_TRUE(set(0x21, 9, 0x0302, data));
  EXPECT_EQ(get(0xA1, 1, 0x0302), data);
  EXPECT_EQ(function_.state().parameters.number, 0);  // not before the next tick
  function_.tick({});
  EXPECT_EQ(function_.state().parameters.number, 9);

  EXPECT_FALSE(set(0x21, 9, 0x0302, ByteVector(data.begin(), data.end() - 1)));
  EXPECT_FALSE(set(0x21, 9, 0x0303, data));
  EXPECT_FALSE(set(0x21, 9, 0x0202, data));
  EXPECT_EQ(get(0xA1, 1, 0x0309), kStalled);
}

TEST_F(Endpoint, RefusedParametersAreTakenAndExplained) {
  ParameterReport parameters;
  parameters.number = 10;
  parameters.axes[1].stiffness = 80;
  std::uint8_t bytes[kParameterReportSize];
  pack(parameters, bytes);
  EXPECT_TRUE(set(0x21, 9, 0x0302, ByteVector(bytes, bytes + sizeof bytes)));
  const ByteVector answer = get(0xA1, 1, 0x0303);
  StatusReport status;
  ASSERT_TRUE(unpack(answer.data(), answer.size(), status));
  EXPECT_EQ(status.refused, 1U);
  EXPECT_EQ(status.refused_number, 10);
  EXPECT_EQ(status.refusal.refusal, Refusal::ViscousFriction);
  EXPECT_EQ(status.refusal.axis, 1);
  EXPECT_TRUE(status.flags & kRefused);
  function_.tick({});
  EXPECT_EQ(function_.state().parameters.number, 0);
  std::uint8_t sent[kInputReportSize];
  ASSERT_TRUE(function_.nextReport(sent));
  InputReport report;
  ASSERT_TRUE(unpack(sent, sizeof sent, report));
  EXPECT_TRUE(report.flags & kRefused);
}

TEST_F(Endpoint, IdleRateIsKept) {
  EXPECT_TRUE(set(0x21, 10, 0x7D00));
  EXPECT_EQ(get(0xA1, 2, 0, 1), ByteVector{0x7D});
}

TEST_F(Endpoint, StallsWhatItDoesNotKnow) {
  EXPECT_EQ(get(0xC0, 1, 0), kStalled);             // vendor request
  EXPECT_EQ(get(0x81, 6, 0x2200, 9, 1), kStalled);  // interface 1
  EXPECT_EQ(get(0xA1, 3, 0), kStalled);             // GET_PROTOCOL: no boot protocol
  EXPECT_FALSE(set(0x00, 3, 1));                    // remote wakeup
  EXPECT_EQ(get(0x80, 10, 0), kStalled);
}

TEST(InputFunctionReports, HaveNoParameters) {
  InputFunction function{InputConfig{}};
  std::uint8_t bytes[64];
  EXPECT_EQ(function.getReport(ReportType::Feature, kParameterReportId, bytes, sizeof bytes), 0U);
  EXPECT_EQ(function.getReport(ReportType::Feature, kStatusReportId, bytes, sizeof bytes), kStatusReportSize);
  EXPECT_EQ(function.getReport(ReportType::Feature, kAxisReportId + 1, bytes, sizeof bytes), kAxisReportSize);
  const std::uint8_t parameters[kParameterReportSize] = {kParameterReportId};
  EXPECT_FALSE(function.setReport(ReportType::Feature, kParameterReportId, parameters, sizeof parameters));
  EXPECT_FALSE(function.nextReport(*reinterpret_cast<std::uint8_t(*)[kInputReportSize]>(bytes)));
  function.tick({});
  EXPECT_TRUE(function.nextReport(*reinterpret_cast<std::uint8_t(*)[kInputReportSize]>(bytes)));
}

}  // namespace
}  // namespace vibe_firmware::control_endpoint_test
