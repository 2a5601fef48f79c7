#pragma once
#include <array>
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
  explicit ScopeJoints(const Calibration& calibration);

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
  const Calibration& calibration() const { return calibration_; }

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

}  // namespace vibe::hardware
