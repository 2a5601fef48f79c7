#include "usb_nodes.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "vibe_firmware/protocol/descriptors.hpp"

namespace vibe {
namespace {

namespace fs = std::filesystem;

/// As the kernel writes it into the uevent file of a HID device on USB.
std::string hidId(std::uint16_t product) {
  char text[64];
  std::snprintf(text, sizeof text, "HID_ID=0003:%08X:%08X", vibe_firmware::kVendorId, product);
  return text;
}

/// Folders inside `folder`; none if it vanishes meanwhile.
std::vector<fs::path> entries(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> found;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    found.push_back(entry->path());
  }
  return found;
}

/// Folder of the HID device behind a hidraw node, if it is one of this product.
std::optional<fs::path> hidFolder(const fs::path& hidraw, std::uint16_t product) {
  const std::string uevent = readAttribute(hidraw / "device/uevent");
  if (uevent.find(hidId(product)) == std::string::npos) return std::nullopt;
  std::error_code error;
  const fs::path folder = fs::canonical(hidraw / "device", error);
  if (error) return std::nullopt;
  return folder;
}

void findInputNodes(const fs::path& hid, UsbNodes& nodes) {
  for (const fs::path& input : entries(hid / "input")) {
    for (const fs::path& node : entries(input)) {
      const std::string name = node.filename();
      if (name.rfind("event", 0) == 0) nodes.event = "/dev/input/" + name;
      if (name.rfind("js", 0) == 0) nodes.joy = "/dev/input/" + name;
    }
  }
}

}  // namespace

std::string readAttribute(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

std::optional<UsbNodes> findUsbNodes(std::uint16_t product) {
  for (const fs::path& hidraw : entries("/sys/class/hidraw")) {
    const auto hid = hidFolder(hidraw, product);
    if (!hid) continue;
    UsbNodes nodes;
    nodes.hidraw = "/dev/" + hidraw.filename().string();
    nodes.usb = hid->parent_path().parent_path();  // HID device, interface, USB device
    findInputNodes(*hid, nodes);
    for (const std::string& node : {nodes.hidraw, nodes.event, nodes.joy}) {
      if (node.empty() || !fs::exists(node)) return std::nullopt;
    }
    return nodes;
  }
  return std::nullopt;
}

bool isKnown(std::uint16_t product) {
  for (const fs::path& device : entries("/sys/bus/hid/devices")) {
    if (readAttribute(device / "uevent").find(hidId(product)) != std::string::npos) return true;
  }
  return false;
}

}  // namespace vibe
