#pragma once
#include <memory>
#include <string>
#include <vector>

#include "vibe_hardware/gamepad/pad_source.hpp"

namespace vibe::hardware {

/// An input device of this machine.
struct PadListing {
  PadInfo info;
  PadState state;
  bool is_pad = false;  ///< has two axes of a stick and a button of a gamepad or joystick
  std::string problem;  ///< why it could not be opened; empty: it could
};

/// All event devices in the order of their numbers.
/// @param folder  where the kernel puts them
std::vector<PadListing> listInputDevices(const std::string& folder = "/dev/input");

/// Opens a pad.
/// @param wanted  a path, or a part of the name or of the phys of a device; empty: the first pad that is not a
///                device of the scope
/// @param why     if none is opened: one sentence that says what was looked for, what was seen and what to do
/// @return null if there is none
std::unique_ptr<PadSource> openPad(const std::string& wanted, std::string& why,
                                   const std::string& folder = "/dev/input");

}  // namespace vibe::hardware
