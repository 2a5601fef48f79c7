#pragma once
#include "cosim_frame.hpp"

namespace vibe_firmware {

/// Puts a control request of the host into a frame. Requests of USB 2.0, table 9-4, and HID 1.11, 7.2.
void setConfiguration(CosimRequest& request);
void setParameters(const ParameterReport& parameters, CosimRequest& request);
void getFeature(std::uint8_t id, std::uint16_t length, CosimRequest& request);

}  // namespace vibe_firmware
