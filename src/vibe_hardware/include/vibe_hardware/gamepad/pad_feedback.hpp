#pragma once
#include <array>

#include "vibe_core/input/step_input.hpp"
#include "vibe_hardware/gamepad/pad_mapping.hpp"
#include "vibe_hardware/gamepad/pad_source.hpp"

namespace vibe::hardware {

/// What is felt as one short pulse of the light motor.
enum class PadPulse {
  Contact,  ///< 0.4 for 0.08 s: the tool touches tissue
  Grab,     ///< 0.7 for 0.2 s: the helix holds tissue
  Bite,     ///< 1.0 for 0.3 s: the needle is through, or the exchange has it
  Failure   ///< 1.0 for 0.6 s: slip, tear-out, broken thread, rejected command
};

/// Response of the tissue for each joint of the scope: effort = stiffness (equilibrium - joint).
struct JointSprings {
  bool touching = false;                               ///< the springs are in force; false: there is no force
  std::array<double, kScopeJointCount> stiffness{};    ///< [N/m], [N m/rad]
  std::array<double, kScopeJointCount> equilibrium{};  ///< [m], [rad]
};

/// Motors of a pad from forces and events.
///
/// Rumble: the strong motor runs at |force on the tool| / rumble_force, at most 1; the weak motor gives pulses. Without
/// a force message for 0.25 s the strong motor stops.
/// Spring: a stick axis (ABS_X, ABS_Y) that gives a joint's position pulls to the equilibrium of the tissue. At a
/// distance of one half of the axis its force is the joint's effort there / full_effort, at most 1. Without a message
/// for 0.1 s it fades to zero within another 0.1 s.
class PadFeedback {
 public:
  explicit PadFeedback(const PadMapping& mapping) : mapping_(mapping) {}  ///< motors off

  /// Amount of the force on the tool, for the strong motor. Its sign does not count; a value that is not finite is
  /// ignored. @param now  steady time [s]  @param force  [N]
  void setForce(double now, double force);
  /// Starts a pulse of the weak motor. While pulses overlap, the stronger level holds until the later end.
  /// @param now  steady time [s]
  void pulse(double now, PadPulse pulse);
  /// Springs of all joints; ignored if a value is not finite. @param now  steady time [s]
  void setSprings(double now, const JointSprings& springs);

  /// Level of the strong motor, 0 to 1. @param now  steady time [s]
  double strongLevel(double now) const;
  /// Level of the weak motor, 0 to 1. @param now  steady time [s]
  double weakLevel(double now) const;
  /// Springs of ABS_X and ABS_Y, with what is left of them. @param now  steady time [s]
  std::array<StickSpring, 2> springs(double now) const;

  /// Sends what has changed, at most 50 times a second.
  void update(double now, PadMotors& motors);
  /// Another pad, or the same again: it knows nothing of what was sent.
  void forgetPad();

 private:
  PadMapping mapping_;
  double force_ = 0;  // [N]
  double force_time_ = -1e9;
  double pulse_level_ = 0;
  double pulse_end_ = -1e9;
  JointSprings joints_;
  double joints_time_ = -1e9;

  double last_update_ = -1e9;
  double last_rumble_ = -1e9;
  std::array<double, 2> sent_levels_{};
  std::array<StickSpring, 2> sent_springs_{};

  void updateRumble(double now, PadMotors& motors);
  void updateSprings(double now, PadMotors& motors);
};

}  // namespace vibe::hardware
