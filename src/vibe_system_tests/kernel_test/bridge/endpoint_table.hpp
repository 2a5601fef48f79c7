#pragma once
#include <usbredirproto.h>

#include <cstdint>
#include <vector>

namespace vibe::hardware {

/// Interfaces and endpoints of a device in the form in which usbredir sends them.
struct EndpointTable {
  usb_redir_interface_info_header interfaces{};
  usb_redir_ep_info_header endpoints{};
};

/// Reads them from a configuration descriptor with all that follows it (USB 2.0, section 9.6).
EndpointTable readEndpoints(const std::vector<std::uint8_t>& configuration);

/// The connect message of a full-speed device, from its device descriptor of 18 bytes.
usb_redir_device_connect_header readDevice(const std::vector<std::uint8_t>& device);

}  // namespace vibe::hardware
