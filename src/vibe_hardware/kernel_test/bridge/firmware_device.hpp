#pragma once
#include <memory>

#include "usb_device.hpp"

namespace vibe {

/// The firmware of the haptic device, linked into this program, with its 1 kHz loop on a timer and the scripted hand.
std::unique_ptr<UsbDevice> makeHapticDevice();

/// The same for the input device.
std::unique_ptr<UsbDevice> makeInputDevice();

}  // namespace vibe
