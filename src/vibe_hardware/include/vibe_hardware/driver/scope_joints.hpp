#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "vibe_hardware/driver/calibration.hpp"
#include "vibe_hardware/driver/report_stream.hpp"

namespace vibe::hardware {

/// Joints of the scope from the samples of both devices.
///
/// A device that starts anew counts from 0 again. The joints then continue where they were, so that nothing jumps, but
/// their positions are not absolute any more until the homing button is pressed.
class ScopeJoints {
 public:
  explicit ScopeJoints(const Calibration& calibration);  ///< no device known yet, joints at 0

  /// @return whether the sample has homed the joints: springs about old positions are void
  bool take(DeviceKind device, const DeviceSample& sample);
  void lose(DeviceKind device);  ///< its joints are not known until its next sample

  bool isKnown() const;  ///< all devices in use have given samples
  /// The device that measures the insertion leads: what is worked out once per report period is due with its samples.
  bool leads(DeviceKind device) const { return device == leader_; }
  bool isHomed() const { return homed_; }  ///< all joints have been homed since their devices started

  const std::array<double, kScopeJointCount>& positions() const { return positions_; }  ///< within the limits
  double effort(int joint) const { return efforts_[static_cast<std::size_t>(joint)]; }  ///< of its axis [N], [N m]
  /// As it is now, after homing and restarts of the device.
  const JointScale& scale(int joint) const { return scales_[static_cast<std::size_t>(joint)]; }
  const Calibration& calibration() const { return calibration_; }  ///< as it was given, before homing

 private:
  Calibration calibration_;
  DeviceKind leader_;
  std::array<JointScale, kScopeJointCount> scales_;
  std::array<double, kScopeJointCount> positions_{};
  std::array<double, kScopeJointCount> efforts_{};
  std::array<double, kScopeJointCount> axes_{};  // last positions of their axes [rad]
  std::array<bool, kScopeJointCount> seen_{};    // has had a sample, ever
  std::array<bool, kScopeJointCount> joint_homed_{};
  std::array<bool, kDeviceKinds> known_{};
  bool homing_pressed_ = false;
  bool homed_ = false;

  void takeJoint(std::size_t joint, const DeviceSample& sample);
  bool takeHoming(DeviceKind device, const DeviceSample& sample);
};

/// The six buttons of scope/buttons from the bits of both devices.
class ScopeButtons {
 public:
  explicit ScopeButtons(const Calibration& calibration) : calibration_(calibration) {}  ///< all released

  /// @param bits  of a report; 0 when the device is lost  @return whether one of the six buttons has changed
  bool take(DeviceKind device, std::uint16_t bits);

  const std::array<std::uint8_t, kButtonCount>& pressed() const { return pressed_; }  ///< 1 while pressed
  /// Any button of a device, also one that is none of the six.
  bool isPressed(const DeviceButton& button) const {
    return (bits_[static_cast<std::size_t>(button.device)] >> button.bit & 1) != 0;
  }

 private:
  Calibration calibration_;
  std::array<std::uint16_t, kDeviceKinds> bits_{};
  std::array<std::uint8_t, kButtonCount> pressed_{};
};

/// Moves helix_advance, helix_rotation and needle_driver while buttons are held, for setups in which no camera tracks
/// the instruments.
class SuturingDeviceDrive {
 public:
  /// Positions of helix_advance, helix_rotation and needle_driver [m], [rad], [m]
  using Positions = std::array<double, kSuturingDeviceJointCount>;

  /// All three joints begin at 0.
  explicit SuturingDeviceDrive(const std::array<ButtonDrive, kSuturingDeviceJointCount>& drives) : drives_(drives) {}

  /// @param elapsed  since the last call; longer gaps than 0.1 s count as that [s]
  void advance(const ScopeButtons& buttons, double elapsed);

  /// Continues from measured positions, clamped to the limits: a camera has tracked the instruments up to now.
  void setPositions(const Positions& positions);

  const Positions& positions() const { return positions_; }  ///< [m], [rad], [m]

 private:
  std::array<ButtonDrive, kSuturingDeviceJointCount> drives_;
  Positions positions_{};
};

}  // namespace vibe::hardware
