#pragma once

#include <memory>
#include <string>

#include "usb_device.hpp"

namespace vibe::hardware {

/// The firmware of the haptic device, linked into this program, with its 1 kHz loop on a timer and the scripted hand.
/// @param serial  its serial number
std::unique_ptr<UsbDevice> makeHapticDevice(const std::string& serial);

/// The same for the input device.
std::unique_ptr<UsbDevice> makeInputDevice(const std::string& serial);

}  // namespace vibe::hardware
