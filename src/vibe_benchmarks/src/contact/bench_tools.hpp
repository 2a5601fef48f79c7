#pragma once

#include <string>

#include <Eigen/Core>

#include "vibe_core/geometry/surface_mesh.hpp"
#include "vibe_core/scene/scene.hpp"
#include "vibe_core/state/state.hpp"
#include "vibe_core/tool/tool_model.hpp"

namespace vibe::benchmarks {

/// A tool without collision shapes that holds the wall with its helix: URDF text. The joint `insertion` moves the tip
/// along the x axis of the base, `rotation` turns it about that axis. Nothing limits its speed or the helix.
std::string freeHandUrdf();

/// Value of the joint `insertion` at which the tip is at the place given to holdByHand() [m].
constexpr double kHandStart = 0.1;

/// Replaces the endoscope of a scene by the free hand, and lets its helix hold against any force.
/// @param tip        place of the helix with `insertion` at kHandStart, in world [m]
/// @param direction  unit, in which `insertion` grows
void holdByHand(const Eigen::Vector3d& tip, const Eigen::Vector3d& direction, Scene& scene);

/// Mean unit normal into the lumen of the wall within 20 mm of a place.
Eigen::Vector3d inwardsAt(const SurfaceView& wall, const Eigen::Vector3d& place);

/// The text of a URDF with other limits for one joint.
/// @throws Error if it has no such joint with a limit
std::string withJointLimits(std::string urdf, const std::string& joint, const JointLimits& limits);

constexpr double kApproach = 0.05;   ///< speed of the scope until it touches [m/s]
constexpr double kTouch = 0.2;       ///< force that shows that the tip presses the far wall, not the entry [N]
constexpr double kClearance = 2e-3;  ///< of the scope before it presses or rams [m]

/// The command to stay there, with the insufflator on.
inline StepInput holdAt(const State& state) {
  StepInput input;
  input.joints = state.joints;
  input.buttons[Insufflate] = 1;
  return input;
}

}  // namespace vibe::benchmarks
