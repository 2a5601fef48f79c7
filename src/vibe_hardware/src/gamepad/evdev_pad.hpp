#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>

#include <libevdev/libevdev.h>
#include <linux/input.h>

#include "vibe_hardware/gamepad/pad_source.hpp"
#include "vibe_hardware/gamepad/pad_state.hpp"

namespace vibe::hardware {

struct LibevdevDeleter {
  void operator()(libevdev* device) const { libevdev_free(device); }
};

/// An open event device: file descriptor and libevdev's view of it.
struct EvdevDevice {
  EvdevDevice() = default;
  EvdevDevice(EvdevDevice&& other) noexcept;
  EvdevDevice& operator=(EvdevDevice&&) = delete;
  ~EvdevDevice();

  int fd = -1;
  std::unique_ptr<libevdev, LibevdevDeleter> handle;
  std::string problem;  ///< why it is not open

  bool isOpen() const { return handle != nullptr; }
};

/// Opens a device for reading and, where the permissions allow, for writing (motors). Never waits.
EvdevDevice openEvdev(const std::string& path);

/// What libevdev says about a device; works for devices without a file too.
PadInfo infoOf(const libevdev& device, const std::string& path);
PadState stateOf(const libevdev& device);
/// Whether it has two axes of a stick and a button of a gamepad or joystick.
bool isPad(const libevdev& device);
/// Whether it is the haptic or the input device, which are gamepads to the kernel and are read by hardware_node.
bool isScopeDevice(const libevdev& device);
/// Whether it is a pad to be opened. @param wanted  part of its name or phys; empty: any pad but a scope device
bool isWanted(const std::string& wanted, const libevdev& device, const std::string& path);

/// Events of a device of the kernel, read through libevdev.
class EvdevPort : public EventPort {
 public:
  explicit EvdevPort(libevdev& device) : device_(device) {}
  Status next(bool resync, PadEvent& event) override;

 private:
  libevdev& device_;
};

constexpr int kRumbleTime = 500;  ///< a program that hangs must not leave the pad shaking [ms]

/// The kernel's effects for levels; levels beyond their range are limited, values that are not finite count as 0.
/// @param id  of the effect to replace; -1: a new one
ff_effect rumbleEffect(double strong, double weak, int id);
ff_effect springEffect(const std::array<StickSpring, 2>& springs, int id);

/// Motors of a device of the kernel: one rumble and one spring effect, replaced in place.
class EvdevMotors : public PadMotors {
 public:
  EvdevMotors(int fd, bool has_rumble, bool has_spring) : fd_(fd), has_rumble_(has_rumble), has_spring_(has_spring) {}
  ~EvdevMotors() override;
  EvdevMotors(const EvdevMotors&) = delete;
  EvdevMotors& operator=(const EvdevMotors&) = delete;

  bool hasRumble() const override { return has_rumble_; }
  bool hasSpring() const override { return has_spring_; }
  bool rumble(double strong, double weak) override;
  bool spring(const std::array<StickSpring, 2>& springs) override;

 private:
  int fd_;
  bool has_rumble_, has_spring_;
  int rumble_id_ = -1;  // of the kernel; -1: not uploaded yet
  int spring_id_ = -1;

  bool play(ff_effect effect, int& id);
  void erase(int& id);
};

/// A pad of the kernel. While it is open, the kernel's own filters of its axes (fuzz, flat) are off where the
/// permissions allow: they swallow small moves. Dead zones are the mapping's.
class EvdevPad : public PadSource {
 public:
  explicit EvdevPad(EvdevDevice device, const std::string& path);
  ~EvdevPad() override;
  EvdevPad(const EvdevPad&) = delete;
  EvdevPad& operator=(const EvdevPad&) = delete;

  const PadInfo& info() const override { return info_; }
  bool update(double) override { return reader_.update(); }
  const PadState& state() const override { return reader_.state(); }
  PadMotors* motors() override { return info_.has_rumble || info_.has_spring ? &motors_ : nullptr; }
  std::uint64_t eventCount() const override { return reader_.eventCount(); }
  std::uint64_t dropCount() const override { return reader_.dropCount(); }
  void setListener(std::function<void(const PadEvent&)> listener) override { reader_.setListener(std::move(listener)); }

 private:
  EvdevDevice device_;
  PadInfo info_;
  EvdevPort port_;
  EventReader reader_;
  EvdevMotors motors_;
  std::map<unsigned, input_absinfo> filtered_;  // axes whose filters were switched off, as they were

  void clearFilters();
  void restoreFilters();
};

}  // namespace vibe::hardware
