#pragma once
#include <string>

namespace vibe::hardware {

/// Sends a command to the bridge outside the virtual machine and waits for its answer; see usb_bridge_main.cpp. Threads
/// and processes may call it at the same time.
/// @throws std::runtime_error with the bridge's error, or if it does not answer within 20 s
void tellBridge(const std::string& command);

}  // namespace vibe::hardware
