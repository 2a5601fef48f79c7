#include "gamepad/evdev_pad.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <ctime>
#include <utility>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "vibe_firmware/protocol/descriptors.hpp"

namespace vibe::hardware {

EventPort::Status EvdevPort::next(bool resync, PadEvent& event) {
  input_event raw{};
  const unsigned mode = resync ? LIBEVDEV_READ_FLAG_SYNC : LIBEVDEV_READ_FLAG_NORMAL;
  const int status = libevdev_next_event(&device_, mode, &raw);
  if (status == -EAGAIN || status == -EINTR) return Status::Empty;
  if (status < 0) return Status::Gone;
  // in normal mode this status announces the loss; in sync mode every event has it
  if (status == LIBEVDEV_READ_STATUS_SYNC && !resync) return Status::Dropped;
  event.time = static_cast<double>(raw.input_event_sec) + 1e-6 * static_cast<double>(raw.input_event_usec);
  event.type = raw.type;
  event.code = raw.code;
  event.value = raw.value;
  return Status::Event;
}

namespace {

double limited(double value, double low) {
  return std::isfinite(value) ? std::clamp(value, low, 1.0) : 0;
}

ff_effect newEffect(int type, int id) {
  ff_effect effect{};
  effect.type = static_cast<__u16>(type);
  effect.id = static_cast<__s16>(id);
  return effect;
}

}  // namespace

ff_effect rumbleEffect(double strong, double weak, int id) {
  ff_effect effect = newEffect(FF_RUMBLE, id);
  effect.u.rumble.strong_magnitude = static_cast<__u16>(std::lround(0xffff * limited(strong, 0)));
  effect.u.rumble.weak_magnitude = static_cast<__u16>(std::lround(0xffff * limited(weak, 0)));
  effect.replay.length = kRumbleTime;
  return effect;
}

ff_effect springEffect(const std::array<StickSpring, 2>& springs, int id) {
  ff_effect effect = newEffect(FF_SPRING, id);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    ff_condition_effect& condition = effect.u.condition[axis];
    const auto coefficient = static_cast<__s16>(std::lround(0x7fff * limited(springs[axis].coefficient, 0)));
    condition.left_saturation = condition.right_saturation = 0xffff;
    condition.left_coeff = condition.right_coeff = coefficient;
    condition.center = static_cast<__s16>(std::lround(0x7fff * limited(springs[axis].centre, -1)));
  }
  return effect;
}

EvdevMotors::~EvdevMotors() {
  erase(rumble_id_);
  erase(spring_id_);
}

bool EvdevMotors::rumble(double strong, double weak) {
  return has_rumble_ && play(rumbleEffect(strong, weak, rumble_id_), rumble_id_);
}

bool EvdevMotors::spring(const std::array<StickSpring, 2>& springs) {
  return has_spring_ && play(springEffect(springs, spring_id_), spring_id_);
}

bool EvdevMotors::play(ff_effect effect, int& id) {
  if (ioctl(fd_, EVIOCSFF, &effect) < 0) return false;
  id = effect.id;
  input_event start{};
  start.type = EV_FF;
  start.code = static_cast<__u16>(id);
  start.value = 1;
  return write(fd_, &start, sizeof start) == static_cast<ssize_t>(sizeof start);
}

void EvdevMotors::erase(int& id) {
  if (id >= 0) ioctl(fd_, EVIOCRMFF, id);  // stops it too; an unplugged device has forgotten it anyway
  id = -1;
}

EvdevPad::EvdevPad(EvdevDevice device, const std::string& path)
    : device_(std::move(device)),
      info_(infoOf(*device_.handle, path)),
      port_(*device_.handle),
      reader_(port_, stateOf(*device_.handle)),
      motors_(device_.fd, info_.has_rumble, info_.has_spring) {
  clearFilters();
}

EvdevPad::~EvdevPad() {
  restoreFilters();
}

void EvdevPad::clearFilters() {
  for (unsigned code = 0; code < ABS_MT_SLOT; ++code) {
    const input_absinfo* axis = libevdev_get_abs_info(device_.handle.get(), code);
    if (axis == nullptr || (axis->fuzz == 0 && axis->flat == 0)) continue;
    const input_absinfo before = *axis;
    input_absinfo open = before;
    open.fuzz = open.flat = 0;
    if (libevdev_kernel_set_abs_info(device_.handle.get(), code, &open) == 0) filtered_[code] = before;
  }
}

void EvdevPad::restoreFilters() {
  for (const auto& [code, before] : filtered_) {
    // the call sets the value too: it must be the present one
    input_absinfo axis = *libevdev_get_abs_info(device_.handle.get(), code);
    axis.fuzz = before.fuzz;
    axis.flat = before.flat;
    libevdev_kernel_set_abs_info(device_.handle.get(), code, &axis);
  }
}

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
