#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "vibe_hardware/crtk/hand_rotation.hpp"
#include "vibe_hardware/crtk/teleop_mapping.hpp"
#include "vibe_hardware/crtk/tool_trail.hpp"
#include "vibe_hardware/driver/joint_scale.hpp"

namespace vibe::hardware {

/// What an arm measures at one time: measured_cp, or measured_js.
struct ArmSample {
  double time = 0;                                     ///< [s]
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< in the base [m]
  Eigen::Quaterniond orientation =
      Eigen::Quaterniond::Identity();             ///< of the moving frame in the base; unit quaternion
  std::array<double, kHandCoordinates> joints{};  ///< by TeleopMapping::arm_joints, if it has any [m], [rad]
};

/// How the tissue answers to motions of the scope's joints, from haptic/parameters.
struct TissueResponse {
  double time = 0;  ///< of arrival [s]
  /// Spring-dampers about a position of each scope joint [m], [rad], [N], [N m]
  std::array<JointSpring, kScopeJointCount> joints{};
};

/// What a step sees.
struct TeleopInput {
  std::optional<ArmSample> sample;                   ///< that has come since the last step
  std::array<double, kJointCount> joints{};          ///< where the hand of the simulator has the joints [m], [rad]
  bool live = false;                                 ///< they come all the time; else only a change says anything
  bool ready = false;                                ///< those are known, and the arm may be used (ENABLED and homed)
  bool clutch = false;                               ///< is pressed
  bool device = false;                               ///< the button that changes over is down
  std::array<std::uint8_t, kButtonCount> buttons{};  ///< by vibe::Button; 1 while pressed
  std::optional<double> gripper;                     ///< angle [rad]
  std::optional<TissueResponse> tissue;              ///< the newest one; empty: nothing is touched
};

/// Everything that lasts from step to step.
struct TeleopState {
  std::array<double, kJointCount> joints{};                       ///< commanded [m], [rad]
  std::array<double, kHandCoordinates> hand{};                    ///< coordinates [m], [rad]
  Eigen::Quaterniond reference = Eigen::Quaterniond::Identity();  ///< since which the rotation counts; unit quaternion
  Eigen::Vector3d turned = Eigen::Vector3d::Zero();               ///< coordinates of the rotation there [rad]
  Eigen::Matrix3d rates = Eigen::Matrix3d::Identity();            ///< HandRotation::rates, now (ratio)
  std::array<JointScale, kJointCount> scales{};  ///< joint = offset + scale * coordinate, of those that follow
  /// Observer and limiter of each scope joint's coordinate; idle where the mapping has none.
  std::array<PortState, kScopeJointCount> ports{};
  std::array<JointSpring, kScopeJointCount> springs{};  ///< that are rendered
  std::array<double, kScopeJointCount> blends{};        ///< what is left of the springs before, fading [N], [N m]
  std::optional<ArmSample> last;  ///< newest measurement; empty: none yet, or older than the mapping's timeout
  ToolTrail trail;                ///< of the joints that were commanded
  /// Where the gripper, no faster than a hand, would have its joint; empty: it has not been taken up yet [m], [rad]
  std::optional<double> gripper;
  bool gripper_moved = false;                            ///< since then it has been away from its ends
  std::array<std::uint8_t, kButtonCount> old_press{};    ///< buttons that must be released before they count
  std::array<std::uint8_t, kButtonCount> held{};         ///< buttons that are down and count
  std::array<std::uint8_t, kButtonCount> switched_on{};  ///< by a press, and off by the next one
  double age = 0;                                        ///< of the oldest measurement at its arrival, lately [s]
  double tissue_time = -1e9;                             ///< of the springs [s]
  double time = 0;                                       ///< of the last step [s]
  double jump_time = -1e9;                               ///< when the arm has jumped [s]
  bool engaged = false;                                  ///< joints follow the hand
  bool on_device = false;                                ///< those of the suturing device; the scope stays
};

/// What a step sends.
struct TeleopOutput {
  std::array<double, kJointCount> joints{};          ///< commanded [m], [rad]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< in the mapping's frame [N]
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< in the mapping's frame [N m]
  std::array<double, kHandCoordinates> efforts{};    ///< of the arm's joints, by arm_joints [N], [N m]
  std::array<std::uint8_t, kButtonCount> buttons{};  ///< 1: counts as pressed
  bool engaged = false;                              ///< joints follow the hand; false: they stay and the forces are 0
  bool on_device = false;       ///< those of the suturing device; the scope stays and the forces are 0
  bool moves_scope = false;     ///< joints of the scope are for the simulator; those of another hand are not
  bool moves_device = false;    ///< the same of the suturing device
  bool passivity_acts = false;  ///< on some coordinate the force of the tissue was lowered, or damping was added
  double withheld = 0;          ///< largest share of a force of the tissue that an account of energy keeps back
  std::string sentence;         ///< one when something has changed that a person should know; else empty
};

/// Disengaged, with full accounts of energy and no force. @param now  of the clock of step() [s]
TeleopState startTeleop(const TeleopMapping& mapping, double now);

/// One step: a function of its arguments. No clock, no graph, no memory but for sentences.
///   joint = where it was when the arm engaged + scale * motion of the hand since, within the limits of the joint.
/// The arm engages when it may be used, measures, and the clutch is up; it lets go when one of these ends. Then forces
/// are 0 and the joints stay. Where somebody else moves the tool, the arm goes on from there (ToolTrail). The gripper
/// moves its joint by as much as itself, from where that is. While the button for the suturing device is pressed, that
/// follows instead of the scope, without forces: the tissue answers to joints of the scope only. A force of the tissue
/// at a joint becomes scale times that on the coordinate (virtual work) times force_scale; new springs do not jump, and
/// without a message for 0.1 s they fade within 0.05 s. The ports reckon with PortConfig::delay or the age of the
/// measurements of the last seconds, whichever is longer. Buttons count while the arm may be used and measures, but for
/// those that were pressed before, or while the arm moved something else than the mapping says; what counts does so
/// until it comes up. What a press has switched on stays on while the arm is silent, but not when it may not be used.
/// @param now  not before the last one [s]
TeleopOutput step(const TeleopMapping& mapping, const ToolLimits& limits, double now, const TeleopInput& input,
                  TeleopState& state);

}  // namespace vibe::hardware
