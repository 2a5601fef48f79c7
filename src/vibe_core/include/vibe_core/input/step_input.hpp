#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace vibe {

/// Joints that the trainee moves, in the order of StepInput::joints.
enum Joint : int { Insertion, Rotation, TipUpDown, TipLeftRight, HelixAdvance, HelixRotation, NeedleDriver };
constexpr int kJointCount = 7;       ///< values of Joint
constexpr int kScopeJointCount = 4;  ///< the first four come from the scope, the rest from the suturing device
extern const std::array<const char*, kJointCount> kJointNames;  ///< as in the URDF: "insertion", "rotation", ...

/// Buttons, in the order of sensor_msgs/Joy::buttons on scope/buttons.
enum Button : int { ApcPedal, HelixGrab, Needle, TTag, Cinch, Insufflate };
constexpr int kButtonCount = 6;                                   ///< values of Button
extern const std::array<const char*, kButtonCount> kButtonNames;  ///< "apc_pedal", "helix_grab", ...

/// What the breath of a patient does. An anaesthetist can hold it.
enum class Breath : std::uint8_t { Free, Held };

/// All external input of one step, and exactly what a recording stores, so that a replay has the same bits.
struct StepInput {
  std::array<double, kJointCount> joints{};               ///< commanded joint positions [m], [rad]
  std::array<std::uint8_t, kButtonCount> buttons{};       ///< 1 while pressed
  int pull_particle = -1;                                 ///< that the pull spring holds; -1: none
  Eigen::Vector3d pull_target = Eigen::Vector3d::Zero();  ///< to which the spring pulls it, world [m]
  Breath breath = Breath::Free;                           ///< no effect in a scene that does not breathe
};

}  // namespace vibe
