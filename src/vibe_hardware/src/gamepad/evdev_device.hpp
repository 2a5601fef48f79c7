#pragma once
#include <libevdev/libevdev.h>

#include <memory>
#include <string>

#include "vibe_hardware/gamepad/pad_state.hpp"

namespace vibe::hardware {

struct LibevdevDeleter {
  void operator()(libevdev* device) const { libevdev_free(device); }
};

/// An open event device: file descriptor and libevdev's view of it.
struct EvdevDevice {
  EvdevDevice() = default;
  EvdevDevice(EvdevDevice&& other) noexcept;
  EvdevDevice& operator=(EvdevDevice&&) = delete;
  ~EvdevDevice();

  int fd = -1;
  std::unique_ptr<libevdev, LibevdevDeleter> handle;
  std::string problem;  ///< why it is not open

  bool isOpen() const { return handle != nullptr; }
};

/// Opens a device for reading and, where the permissions allow, for writing (motors). Never waits.
EvdevDevice openEvdev(const std::string& path);

/// What libevdev says about a device; works for devices without a file too.
PadInfo infoOf(const libevdev& device, const std::string& path);
PadState stateOf(const libevdev& device);
/// Whether it has two axes of a stick and a button of a gamepad or joystick.
bool isPad(const libevdev& device);
/// Whether it is the haptic or the input device, which are gamepads to the kernel and are read by hardware_node.
bool isScopeDevice(const libevdev& device);
/// Whether it is a pad to be opened. @param wanted  part of its name or phys; empty: any pad but a scope device
bool isWanted(const std::string& wanted, const libevdev& device, const std::string& path);

}  // namespace vibe::hardware
