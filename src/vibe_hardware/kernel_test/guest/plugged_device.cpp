#include "plugged_device.hpp"

#include <stdexcept>

#include "bridge_commands.hpp"
#include "vibe_firmware/protocol/descriptors.hpp"

namespace vibe {
namespace {
constexpr double kTimeout = 20;  // [s]
}

const UsbNodes& PluggedDevice::plug() {
  if (nodes_) return *nodes_;
  tellBridge("plug " + name_);
  const auto complete = [this] { return (nodes_ = findUsbNodes(product_)).has_value(); };
  if (!events_.waitUntil(complete, kTimeout)) {
    throw std::runtime_error("no hidraw, event and js node of the " + name_ + " device after 20 s");
  }
  keeps_polling_ = std::make_unique<HidrawFile>(nodes_->hidraw);
  return *nodes_;
}

void PluggedDevice::unplug() {
  if (!nodes_) return;
  tellBridge("unplug " + name_);
  keeps_polling_.reset();
  if (!events_.waitUntil([this] { return !isKnown(product_); }, kTimeout)) {
    throw std::runtime_error("the kernel still has the " + name_ + " device 20 s after it was pulled out");
  }
  nodes_.reset();
}

PluggedDevice& hapticDevice() {
  static PluggedDevice device("haptic", vibe_firmware::kHapticProductId);
  return device;
}

PluggedDevice& inputDevice() {
  static PluggedDevice device("input", vibe_firmware::kInputProductId);
  return device;
}

PluggedDevice& imageDevice() {
  static PluggedDevice device("image", vibe_firmware::kHapticProductId);
  return device;
}

}  // namespace vibe
