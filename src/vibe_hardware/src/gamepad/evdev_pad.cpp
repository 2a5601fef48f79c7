#include "gamepad/evdev_pad.hpp"

namespace vibe::hardware {

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

}  // namespace vibe::hardware
