#include "cosim_target.hpp"

#include <algorithm>
#include <cstring>

namespace vibe_firmware {

HapticSample CosimTarget::sample() {
  HapticSample sample;
  for (int axis = 0; axis < kAxisCount; ++axis) {
    sample.counter[axis] = request_.counter[axis];
    sample.index[axis] = request_.index >> axis & 1;
    sample.index_counter[axis] = request_.index_counter[axis];
  }
  sample.buttons = request_.buttons;
  sample.time_us = request_.time_us;
  return sample;
}

void CosimTarget::writeTorque(const std::array<float, kAxisCount>& torque) {
  for (int axis = 0; axis < kAxisCount; ++axis) {
    reply_.torque[axis] = torque[axis];
    const BridgeInputs inputs = slowDecay(dutyOf(drive_, torque[axis]), kCosimPwmPeriod);
    reply_.first[axis] = inputs.first;
    reply_.second[axis] = inputs.second;
  }
}

CosimReply CosimTarget::end() {
  for (int axis = 0; axis < kAxisCount; ++axis) {
    reply_.position[axis] = state_.axes[axis].position;
    reply_.velocity[axis] = state_.axes[axis].velocity;
    reply_.energy[axis] = state_.axes[axis].energy.balance;
  }
  const CosimReply reply = reply_;
  ++reply_.tick;
  reply_.control_result = kNoControl;
  reply_.has_report = 0;
  return reply;
}

void CosimTarget::poll(ControlHandler& handler) {
  if (request_.has_control == 0) return;
  UsbSetup setup;
  setup.request_type = request_.request_type;
  setup.request = request_.request;
  setup.value = request_.value;
  setup.length = request_.length;
  std::uint8_t response[ControlHandler::kMaxData]{};
  reply_.control_result = handler.handleControl(setup, request_.data, response);
  std::memcpy(reply_.response, response, kCosimData);
  request_.has_control = 0;
}

bool CosimTarget::sendReport(const std::uint8_t* bytes, std::size_t size) {
  std::memcpy(reply_.report, bytes, std::min(size, kInputReportSize));
  reply_.has_report = 1;
  return true;
}

}  // namespace vibe_firmware
