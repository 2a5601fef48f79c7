#include "plugged_device.hpp"

#include <cstdlib>
#include <stdexcept>

#include "bridge_commands.hpp"
#include "vibe_firmware/protocol/descriptors.hpp"

namespace vibe::hardware {
namespace {

using vibe_firmware::kHapticProductId;
using vibe_firmware::kInputProductId;

constexpr double kTimeout = 20;  // [s]

}  // namespace

void PluggedDevice::beginPlug() {
  if (plugged_) return;
  tellBridge("plug " + name_);
  plugged_ = true;
}

void PluggedDevice::beginUnplug() {
  if (!plugged_) return;
  tellBridge("unplug " + name_);
  plugged_ = false;
  keeps_polling_.reset();
}

const UsbNodes& PluggedDevice::plug() {
  beginPlug();
  if (nodes_) return *nodes_;
  const auto complete = [this] { return (nodes_ = findUsbNodes(usb_)).has_value(); };
  if (!events_.waitUntil(complete, kTimeout)) {
    throw std::runtime_error("no hidraw, event and js node of the " + name_ + " device after 20 s");
  }
  keeps_polling_ = std::make_unique<HidrawFile>(nodes_->hidraw);
  return *nodes_;
}

void PluggedDevice::unplug() {
  beginUnplug();
  if (!events_.waitUntil([this] { return !isKnown(usb_); }, kTimeout)) {
    throw std::runtime_error("the kernel still has the " + name_ + " device 20 s after it was pulled out");
  }
  nodes_.reset();
}

bool imageRuns() {
  const char* image = std::getenv("VIBE_IMAGE");
  return image && *image;
}

PluggedDevice& hapticDevice() {
  static PluggedDevice device("haptic", {kHapticProductId, "bridge-haptic"});
  return device;
}

PluggedDevice& inputDevice() {
  static PluggedDevice device("input", {kInputProductId, "bridge-input"});
  return device;
}

PluggedDevice& imageDevice() {
  static PluggedDevice device("image", {kHapticProductId, "QEMU"});
  return device;
}

PluggedDevice& spareHapticDevice() {
  static PluggedDevice device("spare-haptic", {kHapticProductId, "bridge-spare-haptic"});
  return device;
}

PluggedDevice& spareInputDevice() {
  static PluggedDevice device("spare-input", {kInputProductId, "bridge-spare-input"});
  return device;
}

}  // namespace vibe::hardware
