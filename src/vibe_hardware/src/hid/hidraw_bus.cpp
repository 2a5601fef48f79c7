#include "vibe_hardware/hid/hidraw_bus.hpp"

#include <fcntl.h>
#include <hidapi/hidapi.h>
#include <linux/hidraw.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <cwchar>
#include <fstream>
#include <iterator>
#include <mutex>

#include "hid/transport.hpp"
#include "vibe_hardware/hid/file_descriptor.hpp"
#include "vibe_hardware/hid/report_descriptor.hpp"

namespace vibe::hardware {
namespace {

constexpr const char* kKernelFolder = "/sys/class/hidraw";

// hidapi's list of devices and its start and end are not thread-safe
std::mutex& libraryMutex() {
  static std::mutex mutex;
  return mutex;
}
int bus_count = 0;

std::string narrow(const wchar_t* text) {
  std::string result;
  for (; text != nullptr && *text != 0; ++text)
    result += *text >= 0x20 && *text < 0x7F ? static_cast<char>(*text) : '?';
  return result;
}

class HidrawPort : public HidPort {
 public:
  HidrawPort(hid_device* device, std::string path) : device_(device), path_(std::move(path)) {}
  ~HidrawPort() override { hid_close(device_); }
  HidrawPort(const HidrawPort&) = delete;
  HidrawPort& operator=(const HidrawPort&) = delete;

  std::size_t read(std::uint8_t* bytes, std::size_t capacity, double timeout) override {
    const int milliseconds = static_cast<int>(std::ceil(1e3 * timeout));
    const int size = hid_read_timeout(device_, bytes, capacity, milliseconds);
    if (size < 0) throw DeviceGone(path_ + " cannot be read any more: it was unplugged, or has reset");
    return static_cast<std::size_t>(size);
  }

  std::size_t getFeature(std::uint8_t id, std::uint8_t* bytes, std::size_t capacity) override {
    bytes[0] = id;
    errno = 0;
    const int size = hid_get_feature_report(device_, bytes, capacity);
    if (size < 0) failTransfer(path_, errno, "feature report " + std::to_string(id) + " cannot be read");
    return static_cast<std::size_t>(size);
  }

  void setFeature(const std::uint8_t* bytes, std::size_t size) override {
    errno = 0;
    if (hid_send_feature_report(device_, bytes, size) < 0) {
      failTransfer(path_, errno, "feature report " + std::to_string(bytes[0]) + " cannot be set");
    }
  }

  // hidapi 0.13 has no call for it; the kernel shows it
  std::vector<std::uint8_t> reportDescriptor() override {
    const std::string node = path_.substr(path_.find_last_of('/') + 1);
    std::ifstream file(std::string(kKernelFolder) + "/" + node + "/device/report_descriptor", std::ios::binary);
    std::vector<std::uint8_t> bytes(kMaxReportDescriptor + 1);
    file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (file.bad()) throw DeviceGone(path_ + " went while its report descriptor was read");
    bytes.resize(static_cast<std::size_t>(file.gcount()));
    return bytes;
  }

 private:
  hid_device* device_;
  std::string path_;
};

/// Why a node of the kernel cannot be opened, and what to do.
[[noreturn]] void failOpen(const std::string& path, int error) {
  if (error == EACCES || error == EPERM) {
    throw std::runtime_error("This user may not open " + path +
                             ": install the udev rule 60-vibe.rules, plug the device in again and, without a local "
                             "login, join the group plugdev (docs/hardware.md, udev rule).");
  }
  if (error == ENOENT &&
      access((std::string(kKernelFolder) + path.substr(path.find_last_of('/'))).c_str(), F_OK) == 0) {
    throw std::runtime_error("The kernel knows the device " + path +
                             ", but the file is not here: if this is a container, pass it in, else start udev.");
  }
  throw DeviceGone(path + " cannot be opened: " + std::strerror(error));
}

/// hidapi 0.13 does not say why it cannot open a node, and crashes on one that answers no request.
void checkNode(const std::string& path) {
  const FileDescriptor file(::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK));
  if (!file) failOpen(path, errno);
  int size = 0;
  if (::ioctl(file.get(), HIDIOCGRDESCSIZE, &size) < 0) failOpen(path, errno);
}

}  // namespace

HidrawBus::HidrawBus(std::uint16_t vendor) : vendor_(vendor) {
  const std::lock_guard<std::mutex> lock(libraryMutex());
  if (bus_count++ == 0) hid_init();
}

HidrawBus::~HidrawBus() {
  const std::lock_guard<std::mutex> lock(libraryMutex());
  if (--bus_count == 0) hid_exit();
}

std::vector<HidInfo> HidrawBus::list() {
  if (access(kKernelFolder, F_OK) != 0) {
    throw std::runtime_error(
        "No HID device can be seen: there is no /sys/class/hidraw. Load the module hid or, in a container or virtual "
        "machine, pass the device in; devices are used as soon as they appear.");
  }
  const std::lock_guard<std::mutex> lock(libraryMutex());
  std::vector<HidInfo> found;
  hid_device_info* const first = hid_enumerate(vendor_, 0);
  for (const hid_device_info* info = first; info != nullptr; info = info->next) {
    // a device with several application collections is listed once for each of them
    if (!found.empty() && found.back().path == info->path) continue;
    found.push_back(
        {info->path, info->vendor_id, info->product_id, narrow(info->serial_number), narrow(info->product_string)});
  }
  hid_free_enumeration(first);
  return found;
}

std::unique_ptr<HidPort> HidrawBus::open(const std::string& path) {
  const std::lock_guard<std::mutex> lock(libraryMutex());
  checkNode(path);
  hid_device* const device = hid_open_path(path.c_str());
  if (device == nullptr) throw DeviceGone(narrow(hid_error(nullptr)));
  return std::make_unique<HidrawPort>(device, path);
}

}  // namespace vibe::hardware
