#pragma once
#include <string>
#include <vector>

#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// Position of a joint that only a picture needs.
struct DrawnJoint {
  std::string name;     ///< as in the URDF
  double position = 0;  ///< [m], [rad]
};

/// Where the parts of the suturing device are that the simulation has no joints for, as far as the URDF has them:
///   needle_arm_hinge, needle_hook_turn    the arm turns about its hinge and the hook about the needle's point, so that
///                                         they stay joined (links needle_arm_pin and needle_hook_pin)
///   needle_slide, needle_turn, needle_draw  the needle: on the hook, in the anchor exchange, or gone as T-tag
///   argon_probe                           the end of the probe before the distal face: marking.probe_length while the
///                                         pedal is down, else the offset of its mimic element
/// In the URDF they mimic needle_driver; what is told here comes first. Follows from model and state alone.
/// @param model  with a tool
std::vector<DrawnJoint> drawnJoints(const Model& model, const State& state);

}  // namespace vibe
