#pragma once

#include <vector>

#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/scene/scene.hpp"

namespace vibe {

/// The particles at the ends of the organ that the scene holds in place (attach_oesophagus, attach_duodenum). They are
/// part of the body that a solver is made for: their rows are not in the factor.
/// @returns per particle, 1: it never moves
std::vector<char> attachedNodes(const Scene& scene, const Organ& organ);

}  // namespace vibe
