#pragma once
#include <Eigen/Geometry>
#include <functional>

namespace vibe::hardware {

/// An arm with a handle that a hand holds, as far as its CRTK interface shows it: a mass that forces push and that a
/// spring and a damper pull to where the person intends; about each axis the same with an inertia.
struct EmulatedArmConfig {
  double mass = 0.25;           ///< of handle and hand [kg]
  double inertia = 2e-4;        ///< [kg m^2]
  double hand_stiffness = 200;  ///< [N/m]
  double hand_damping = 10;     ///< [N s/m]
  double turn_stiffness = 0.5;  ///< [N m/rad]
  double turn_damping = 0.01;   ///< [N m s/rad]
};

/// Motion of the handle, and the work done on it; begins at rest at the origin of the base.
struct EmulatedArmState {
  Eigen::Vector3d position = Eigen::Vector3d::Zero(), velocity = Eigen::Vector3d::Zero();  ///< in the base [m], [m/s]
  Eigen::Vector3d turn = Eigen::Vector3d::Zero(), spin = Eigen::Vector3d::Zero();  ///< rotation vector [rad], [rad/s]
  double given = 0;  ///< energy that the forces have given to the handle [J]
};

/// Where the person intends to have the handle.
struct HandIntent {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< in the base [m]
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();      ///< rotation vector [rad]
};

/// One step with forces that act all the time, in the base. A function of its arguments; to be called with steps of 0.1
/// ms to 1 ms.
void stepArm(const EmulatedArmConfig& config, double dt, const Eigen::Vector3d& force, const Eigen::Vector3d& torque,
             const HandIntent& intent, EmulatedArmState& state);

/// Orientation of the handle in the base; unit quaternion.
Eigen::Quaterniond orientationOf(const EmulatedArmState& state);

}  // namespace vibe::hardware
