#pragma once
#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "vibe_firmware/protocol/descriptors.hpp"
#include "vibe_firmware/protocol/haptic_function.hpp"
#include "vibe_firmware/protocol/input_function.hpp"
#include "vibe_hardware/driver/device_driver.hpp"
#include "vibe_hardware/hid/hid_port.hpp"
#include "vibe_hardware/hid/report_descriptor.hpp"

namespace vibe::hardware {

using Packet = std::vector<std::uint8_t>;
using Packets = std::vector<Packet>;

/// The firmware of one device on a bus of the test. Time is that of the bus.
class FakeDevice {
 public:
  FakeDevice(DeviceKind kind, std::string serial) : kind_(kind), serial_(std::move(serial)) { start(); }

  HidInfo info() const {
    const bool haptic = kind_ == DeviceKind::Haptic;
    return {"/fake/" + serial_, vibe_firmware::kVendorId,
            haptic ? vibe_firmware::kHapticProductId : vibe_firmware::kInputProductId, serial_, "fake"};
  }

  /// Power on: counts, sequence number and time begin at 0.
  void start() {
    haptic_ = std::make_unique<vibe_firmware::HapticFunction>(haptic_config, serial_.c_str());
    input_ = std::make_unique<vibe_firmware::InputFunction>(vibe_firmware::InputConfig{}, serial_.c_str());
    sample = {};
    waiting.clear();
    elapsed_ = 0;
    ticks_ = 0;
  }

  vibe_firmware::HidFunction& function() {
    return kind_ == DeviceKind::Haptic ? static_cast<vibe_firmware::HidFunction&>(*haptic_) : *input_;
  }
  vibe_firmware::HapticFunction& haptic() { return *haptic_; }

  /// Runs the firmware until a time of the bus, with a clock that may be fast or slow.
  void run(double from, double to) {
    elapsed_ += (to - from) * clock_rate;
    for (; static_cast<double>(ticks_) < elapsed_ / 1e-3; ++ticks_) tick(from);
  }

  void queue(double sent, const Packet& packet) {
    const double arrival = std::max(sent + delay(), waiting.empty() ? 0.0 : waiting.back().first);
    waiting.emplace_back(arrival, packet);
  }

  vibe_firmware::HapticConfig haptic_config;  ///< at the next start()
  bool plugged = true;
  bool stopped = false;  ///< the firmware hangs: no reports, no answers
  double clock_rate = 1;
  std::function<double()> delay = [] { return 0.0; };            ///< of the next report [s]
  std::function<Packets(const Packet&)> tamper;                  ///< what becomes of a report
  std::function<void(std::uint8_t id, Packet&)> tamper_feature;  ///< what becomes of an answer
  std::function<void()> request;                                 ///< called at each request for a feature report
  vibe_firmware::HapticSample sample;                            ///< what the board reads
  std::deque<std::pair<double, Packet>> waiting;                 ///< reports with their times of arrival
  std::vector<double> sample_times;                              ///< of the bus, of all reports [s]
  int gone = 0;                                                  ///< times that opening it fails as if it were gone
  std::string open_error;                                        ///< sentence if it may not be opened

 private:
  DeviceKind kind_;
  std::string serial_;
  std::unique_ptr<vibe_firmware::HapticFunction> haptic_;
  std::unique_ptr<vibe_firmware::InputFunction> input_;
  double elapsed_ = 0;  // on the device's clock [s]
  std::int64_t ticks_ = 0;

  void tick(double now) {
    sample.time_us = static_cast<std::uint32_t>(1000 * ticks_);
    if (kind_ == DeviceKind::Haptic) {
      haptic_->tick(sample);
    } else {
      input_->tick(sample);
    }
    std::uint8_t bytes[vibe_firmware::kInputReportSize];
    const bool due = kind_ == DeviceKind::Haptic ? haptic_->nextReport(bytes) : input_->nextReport(bytes);
    if (!due || stopped) return;
    sample_times.push_back(now);
    const Packet packet(bytes, bytes + sizeof bytes);
    for (const Packet& p : tamper ? tamper(packet) : Packets{packet}) queue(now, p);
  }
};

/// A bus with fake devices and a clock that goes on while somebody waits.
class FakeBus : public HidBus {
 public:
  double now = 100;
  std::vector<FakeDevice*> devices;
  std::string error;  ///< sentence if the bus cannot be used
  int lists = 0;

  void advance(double seconds) {
    const double end = now + seconds;
    while (now < end - 1e-9) {
      const double step = std::min(2e-4, end - now);
      for (FakeDevice* device : devices) device->run(now, now + step);
      now += step;
    }
  }

  std::vector<HidInfo> list() override {
    ++lists;
    if (!error.empty()) throw std::runtime_error(error);
    std::vector<HidInfo> infos;
    for (const FakeDevice* device : devices) {
      if (device->plugged) infos.push_back(device->info());
    }
    return infos;
  }

  std::unique_ptr<HidPort> open(const std::string& path) override {
    for (FakeDevice* device : devices) {
      if (!device->plugged || device->info().path != path) continue;
      if (device->gone > 0 && device->gone-- > 0) throw DeviceGone(path + ": Device or resource busy");
      if (!device->open_error.empty()) throw std::runtime_error(device->open_error);
      device->waiting.clear();
      return std::make_unique<Port>(*this, *device);
    }
    throw DeviceGone(path + " is not there");
  }

 private:
  class Port : public HidPort {
   public:
    Port(FakeBus& bus, FakeDevice& device) : bus_(bus), device_(device) {}

    std::size_t read(std::uint8_t* bytes, std::size_t capacity, double timeout) override {
      const double end = bus_.now + timeout;
      while (true) {
        check();
        if (!device_.waiting.empty() && device_.waiting.front().first <= bus_.now) break;
        if (bus_.now >= end - 1e-9) return 0;
        bus_.advance(std::min(2e-4, end - bus_.now));
      }
      const Packet packet = device_.waiting.front().second;
      device_.waiting.pop_front();
      const std::size_t size = std::min(packet.size(), capacity);
      std::copy_n(packet.begin(), size, bytes);
      return size;
    }

    std::size_t getFeature(std::uint8_t id, std::uint8_t* bytes, std::size_t capacity) override {
      check();
      if (device_.request) device_.request();
      const std::size_t size = device_.function().getReport(vibe_firmware::ReportType::Feature, id, bytes, capacity);
      if (size == 0) throw ReportRejected("stall");
      Packet packet(bytes, bytes + size);
      if (device_.tamper_feature) device_.tamper_feature(id, packet);
      std::copy_n(packet.begin(), std::min(packet.size(), capacity), bytes);
      return packet.size();
    }

    void setFeature(const std::uint8_t* bytes, std::size_t size) override {
      check();
      if (device_.request) device_.request();
      if (!device_.function().setReport(vibe_firmware::ReportType::Feature, bytes[0], bytes, size)) {
        throw ReportRejected("stall");
      }
    }

    std::vector<std::uint8_t> reportDescriptor() override {
      const vibe_firmware::Bytes bytes = device_.function().reportDescriptor();
      return {bytes.data, bytes.data + bytes.size};
    }

   private:
    FakeBus& bus_;
    FakeDevice& device_;

    void check() const {
      if (!device_.plugged) throw DeviceGone(device_.info().path + " was unplugged");
    }
  };
};

/// Everything a driver says.
struct Sentences {
  std::vector<std::string> all;

  MessageSink sink() {
    return [this](Severity, const std::string& sentence) { all.push_back(sentence); };
  }
  int count(const std::string& part) const {
    int n = 0;
    for (const std::string& sentence : all) n += sentence.find(part) != std::string::npos ? 1 : 0;
    return n;
  }
};

}  // namespace vibe::hardware
