#include "scenario.hpp"

#include <cstring>

namespace vibe_firmware {
namespace {

constexpr std::uint16_t kFeature = 0x0300;

void setup(std::uint8_t type, std::uint8_t number, std::uint16_t value, std::uint16_t length, CosimRequest& request) {
  request.has_control = 1;
  request.request_type = type;
  request.request = number;
  request.value = value;
  request.length = length;
}

}  // namespace

void setConfiguration(CosimRequest& request) {
  setup(0x00, 9, 1, 0, request);
}

void setParameters(const ParameterReport& parameters, CosimRequest& request) {
  setup(0x21, 9, kFeature | kParameterReportId, kParameterReportSize, request);
  std::uint8_t bytes[kParameterReportSize];
  pack(parameters, bytes);
  std::memcpy(request.data, bytes, sizeof bytes);
}

void getFeature(std::uint8_t id, std::uint16_t length, CosimRequest& request) {
  setup(0xA1, 1, static_cast<std::uint16_t>(kFeature | id), length, request);
}

}  // namespace vibe_firmware
