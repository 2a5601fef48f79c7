#pragma once

#include <string>

#include <Eigen/Core>

#include "vibe_core/geometry/surface_mesh.hpp"
#include "vibe_core/model/model.hpp"
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

/// The model of another scene or tool on the same organ. @param urdf  text, of the tool
std::shared_ptr<Model> modelWith(const Scene& scene, const std::string& urdf, const Model& like);

/// Inserts the scope, straight, until it touches the wall, and withdraws it by kClearance; a second later it is at
/// rest.
/// @param state  the start, and the end
/// @return the value of the joint `insertion` at contact
/// @throws Error if it does not reach the wall
double insertionAtContact(const std::shared_ptr<const Model>& model, State& state);

/// So that the times of a motion count from here.
inline void startClock(State& state) {
  state.step = 0;
  state.time = 0;
}

/// All joints on their way from one command to another, with the buttons of the second. @param part  of the way, 0 to 1
inline StepInput between(const StepInput& from, const StepInput& to, double part) {
  StepInput input = to;
  for (std::size_t j = 0; j < input.joints.size(); ++j)
    input.joints[j] = from.joints[j] + part * (to.joints[j] - from.joints[j]);
  return input;
}

/// The command to stay there, with the insufflator on.
inline StepInput holdAt(const State& state) {
  StepInput input;
  input.joints = state.joints;
  input.buttons[Insufflate] = 1;
  return input;
}

}  // namespace vibe::benchmarks
