#pragma once
#include <string>

#include "vibe_core/contact/tool_model.hpp"

namespace vibe::benchmarks {

/// The text of a URDF with other limits for one joint.
/// @throws Error if it has no such joint with a limit
std::string withJointLimits(std::string urdf, const std::string& joint, const JointLimits& limits);

}  // namespace vibe::benchmarks
