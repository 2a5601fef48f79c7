#include "gamepad/evdev_device.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <utility>

#include "vibe_firmware/protocol/descriptors.hpp"

namespace vibe::hardware {
namespace {

const char* textOf(const char* text) {
  return text != nullptr ? text : "";
}

std::string openingProblem(int error) {
  if (error == EACCES || error == EPERM)
    return "may not be read by this user (add the user to the group 'input' and log in again)";
  return std::string("cannot be opened (") + std::strerror(error) + ")";
}

}  // namespace

EvdevDevice::EvdevDevice(EvdevDevice&& other) noexcept
    : fd(std::exchange(other.fd, -1)), handle(std::move(other.handle)), problem(std::move(other.problem)) {}

EvdevDevice::~EvdevDevice() {
  handle.reset();
  if (fd >= 0) close(fd);
}

EvdevDevice openEvdev(const std::string& path) {
  EvdevDevice device;
  device.fd = open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (device.fd < 0) device.fd = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (device.fd < 0) {
    device.problem = openingProblem(errno);
    return device;
  }
  libevdev* handle = nullptr;
  const int result = libevdev_new_from_fd(device.fd, &handle);
  if (result != 0) {
    device.problem = std::string("is no event device (") + std::strerror(-result) + ")";
    return device;
  }
  device.handle.reset(handle);
  libevdev_set_clock_id(handle, CLOCK_MONOTONIC);
  return device;
}

PadInfo infoOf(const libevdev& device, const std::string& path) {
  PadInfo info;
  info.name = textOf(libevdev_get_name(&device));
  info.phys = textOf(libevdev_get_phys(&device));
  info.path = path;
  info.bus = libevdev_get_id_bustype(&device);
  info.vendor = libevdev_get_id_vendor(&device);
  info.product = libevdev_get_id_product(&device);
  info.version = libevdev_get_id_version(&device);
  info.has_rumble = libevdev_has_event_code(&device, EV_FF, FF_RUMBLE) == 1;
  info.has_spring = libevdev_has_event_code(&device, EV_FF, FF_SPRING) == 1;
  return info;
}

PadState stateOf(const libevdev& device) {
  PadState state;
  for (int code = 0; code < ABS_MT_SLOT; ++code) {
    const input_absinfo* axis = libevdev_get_abs_info(&device, static_cast<unsigned>(code));
    if (axis != nullptr) state.axes[code] = {axis->minimum, axis->maximum, axis->value};
  }
  for (int code = BTN_MISC; code < KEY_CNT; ++code) {
    if (libevdev_has_event_code(&device, EV_KEY, static_cast<unsigned>(code)) == 0) continue;
    state.buttons[code].down = libevdev_get_event_value(&device, EV_KEY, static_cast<unsigned>(code)) != 0;
  }
  return state;
}

bool isPad(const libevdev& device) {
  if (libevdev_has_property(&device, INPUT_PROP_ACCELEROMETER) == 1) return false;
  if (libevdev_has_event_code(&device, EV_ABS, ABS_X) == 0) return false;
  if (libevdev_has_event_code(&device, EV_ABS, ABS_Y) == 0) return false;
  for (unsigned code = BTN_JOYSTICK; code < BTN_DIGI; ++code)
    if (libevdev_has_event_code(&device, EV_KEY, code) == 1) return true;
  return false;
}

bool isScopeDevice(const libevdev& device) {
  const int product = libevdev_get_id_product(&device);
  return libevdev_get_id_vendor(&device) == vibe_firmware::kVendorId &&
         (product == vibe_firmware::kHapticProductId || product == vibe_firmware::kInputProductId);
}

bool isWanted(const std::string& wanted, const libevdev& device, const std::string& path) {
  if (wanted.empty()) return isPad(device) && !isScopeDevice(device);
  const PadInfo info = infoOf(device, path);
  return info.name.find(wanted) != std::string::npos || info.phys.find(wanted) != std::string::npos;
}

}  // namespace vibe::hardware
