#pragma once
#include <array>
#include <optional>
#include <string>

#include "vibe_core/input/step_input.hpp"
#include "vibe_hardware/driver/device_driver.hpp"
#include "vibe_hardware/driver/joint_scale.hpp"

namespace vibe::hardware {

constexpr int kDeviceButtons = 16;  ///< bits of a report

/// A button of a device.
struct DeviceButton {
  DeviceKind device = DeviceKind::Input;  ///< that has the button
  int bit = 0;                            ///< 0 to 15
};

/// Where a joint of the scope is measured.
struct JointCalibration {
  DeviceKind device = DeviceKind::Haptic;  ///< whose axis measures the joint
  int axis = 0;                            ///< of that device, 0 or 1; no two joints share one
  JointScale scale;                        ///< direction included
  double lower = 0, upper = 0;             ///< positions beyond are published as these [m], [rad]
  std::optional<double> home;              ///< position when the homing button is pressed [m], [rad]
};

/// One of the three joints of the suturing device, driven by two buttons.
struct ButtonDrive {
  /// Buttons that move the joint to its upper and to its lower limit while held; both: it stays.
  DeviceButton forward, backward;
  double speed = 0;             ///< [m/s], [rad/s]
  double lower = 0, upper = 0;  ///< [m], [rad]
};
/// Joints of the suturing device: helix_advance, helix_rotation, needle_driver.
constexpr int kSuturingDeviceJointCount = kJointCount - kScopeJointCount;

/// What the user says about the devices and how they are held: docs/hardware.md, "Calibration".
struct Calibration {
  std::array<DeviceSelection, kDeviceKinds> devices;      ///< by DeviceKind
  std::array<JointCalibration, kScopeJointCount> joints;  ///< by vibe::Joint
  /// What presses each vibe::Button; empty: nothing does.
  std::array<std::optional<DeviceButton>, kButtonCount> buttons;
  /// Its press brings all joints that have a `home` there; empty: there is no homing.
  std::optional<DeviceButton> homing;
  /// helix_advance, helix_rotation, needle_driver; absent: these joints come from somewhere else
  std::optional<std::array<ButtonDrive, kSuturingDeviceJointCount>> suturing_device;

  /// @param address  file, or package:// address
  /// @throws Error with file, line, key and remedy
  static Calibration load(const std::string& address);
  /// @param place  what to call the text in errors
  static Calibration parse(const std::string& yaml, const std::string& place);

  bool uses(DeviceKind device) const;  ///< for a joint
  /// The joint that an axis measures; -1: none.
  int jointOf(DeviceKind device, int axis) const;
};

}  // namespace vibe::hardware
