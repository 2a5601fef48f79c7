#include "vibe_hardware/emulator/emulator_bus.hpp"

#include <algorithm>

namespace vibe::hardware {
namespace {

constexpr std::size_t kMaxWaiting = 256;

std::size_t copy(const std::vector<std::uint8_t>& from, std::uint8_t* to, std::size_t capacity) {
  const std::size_t size = std::min(from.size(), capacity);
  std::copy_n(from.begin(), size, to);
  return size;
}

}  // namespace

struct EmulatorBus::Device {
  Device(EmulatedDevice& emulated, std::string path_)
      : device(emulated), usb(emulated.function()), path(std::move(path_)) {}

  EmulatedDevice& device;
  UsbHost usb;
  std::string path;
  std::deque<std::vector<std::uint8_t>> reports;
};

class EmulatorBus::Port : public HidPort {
 public:
  explicit Port(Device& device) : device_(device) {}

  std::size_t read(std::uint8_t* bytes, std::size_t capacity, double /*timeout*/) override {
    if (device_.reports.empty()) return 0;
    const std::vector<std::uint8_t> report = std::move(device_.reports.front());
    device_.reports.pop_front();
    return copy(report, bytes, capacity);
  }

  std::size_t getFeature(std::uint8_t id, std::uint8_t* bytes, std::size_t capacity) override {
    const std::vector<std::uint8_t> report = device_.usb.getFeature(id);
    if (report.empty()) throw ReportRejected("The emulated device rejects report " + std::to_string(id) + ".");
    return copy(report, bytes, capacity);
  }

  void setFeature(const std::uint8_t* bytes, std::size_t size) override {
    if (!device_.usb.setFeature(bytes, size)) throw ReportRejected("The emulated device rejects a report.");
  }

  std::vector<std::uint8_t> reportDescriptor() override { return device_.usb.reportDescriptor(); }

 private:
  Device& device_;
};

EmulatorBus::EmulatorBus(Emulator& emulator) {
  for (const DeviceKind kind : {DeviceKind::Haptic, DeviceKind::Input})
    devices_[static_cast<std::size_t>(kind)] = std::make_unique<Device>(
        emulator.device(kind), kind == DeviceKind::Haptic ? "emulated/haptic" : "emulated/input");
}

EmulatorBus::~EmulatorBus() = default;

void EmulatorBus::collect() {
  for (const auto& device : devices_) {
    std::uint8_t bytes[vibe_firmware::kInputReportSize];
    if (!device->device.nextReport(bytes)) continue;
    if (device->reports.size() == kMaxWaiting) device->reports.pop_front();
    device->reports.emplace_back(std::begin(bytes), std::end(bytes));
  }
}

std::vector<HidInfo> EmulatorBus::list() {
  std::vector<HidInfo> found;
  for (const auto& device : devices_)
    found.push_back(
        {device->path, device->usb.vendor(), device->usb.product(), device->usb.serial(), device->usb.name()});
  return found;
}

std::unique_ptr<HidPort> EmulatorBus::open(const std::string& path) {
  for (const auto& device : devices_) {
    if (device->path != path) continue;
    device->reports.clear();
    return std::make_unique<Port>(*device);
  }
  throw DeviceGone("There is no emulated device " + path + ".");
}

}  // namespace vibe::hardware
