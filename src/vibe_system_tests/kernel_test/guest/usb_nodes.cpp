#include "usb_nodes.hpp"

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>

#include <fcntl.h>
#include <linux/netlink.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "vibe_firmware/protocol/descriptors.hpp"

namespace vibe::hardware {

namespace {

namespace fs = std::filesystem;

/// Whether this uevent file is that of a HID device on USB with our vendor id, this product id and this serial number.
bool matches(const fs::path& uevent, const UsbName& name) {
  char id[64];
  std::snprintf(id, sizeof id, "HID_ID=0003:%08X:%08X\n", vibe_firmware::kVendorId, name.product);
  const std::string text = readAttribute(uevent) + "\n";
  return text.find(id) != std::string::npos && text.find("HID_UNIQ=" + name.serial + "\n") != std::string::npos;
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

/// Folder of the HID device behind a hidraw node, if it has this name.
std::optional<fs::path> hidFolder(const fs::path& hidraw, const UsbName& name) {
  if (!matches(hidraw / "device/uevent", name)) return std::nullopt;
  std::error_code error;
  const fs::path folder = fs::canonical(hidraw / "device", error);
  if (error) return std::nullopt;
  return folder;
}

void findInputNodes(const fs::path& hid, UsbNodes& nodes) {
  for (const fs::path& input : entries(hid / "input")) {
    for (const fs::path& folder : entries(input)) {
      const std::string node = folder.filename();
      if (node.rfind("event", 0) == 0) nodes.event = "/dev/input/" + node;
      if (node.rfind("js", 0) == 0) nodes.joy = "/dev/input/" + node;
    }
  }
}

}  // namespace

std::string readAttribute(const std::string& path) {
  // not a stream: those throw when the device goes while they read
  std::string text(4096, '\0');
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const ssize_t size = file < 0 ? 0 : read(file, text.data(), text.size());
  if (file >= 0) close(file);
  text.resize(size < 0 ? 0 : size);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

std::optional<UsbNodes> findUsbNodes(const UsbName& name) {
  for (const fs::path& hidraw : entries("/sys/class/hidraw")) {
    const auto hid = hidFolder(hidraw, name);
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

bool isKnown(const UsbName& name) {
  for (const fs::path& device : entries("/sys/bus/hid/devices")) {
    if (matches(device / "uevent", name)) return true;
  }
  return false;
}

KernelEvents::KernelEvents()
    : socket_(socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, NETLINK_KOBJECT_UEVENT)) {
  sockaddr_nl address{};
  address.nl_family = AF_NETLINK;
  address.nl_groups = 1;  // the kernel's own events
  if (socket_ < 0 || bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    throw std::runtime_error(std::string("the kernel's device events cannot be read: ") + std::strerror(errno));
  }
}

KernelEvents::~KernelEvents() {
  close(socket_);
}

bool KernelEvents::waitUntil(const std::function<bool()>& condition, double timeout) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(timeout);
  char event[8192];
  while (!condition()) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    pollfd wait{socket_, POLLIN, 0};
    if (left <= 0 || poll(&wait, 1, static_cast<int>(left)) < 0) return false;
    while (recv(socket_, event, sizeof event, 0) > 0) {
    }
  }
  return true;
}

}  // namespace vibe::hardware
