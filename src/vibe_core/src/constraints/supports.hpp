#pragma once

#include <vector>

#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/scene/scene.hpp"

namespace vibe {

/// Whether the scene fixes the particles of this end.
inline bool isHeld(const Scene& scene, End end) {
  return (end == End::Oesophagus && scene.attach_oesophagus) || (end == End::Duodenum && scene.attach_duodenum);
}

/// The particles at the ends of the organ that the scene holds in place (attach_oesophagus, attach_duodenum). They are
/// part of the body that a solver is made for: their rows are not in the factor.
/// @returns per particle, 1: it never moves
std::vector<char> attachedNodes(const Scene& scene, const Organ& organ);

/// The elastic foundation (Winkler): a spring from each particle to its rest position. It acts in all three directions
/// and is part of the body that a solver is made for, because an implicit solver has it in its factor.
/// @param areas  of wall per particle [m^2]
/// @returns the stiffness per particle [N/m]; empty in a scene without foundation
std::vector<double> foundationSprings(const Scene& scene, const std::vector<double>& areas);

}  // namespace vibe
