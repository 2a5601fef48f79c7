#pragma once

#include <vector>

#include "vibe_core/scene/scene.hpp"

namespace vibe {

/// The elastic foundation (Winkler): a spring from each particle to its rest position. It acts in all three directions
/// and is part of the body that a solver is made for, because an implicit solver has it in its factor.
/// @param areas  of wall per particle [m^2]
/// @returns the stiffness per particle [N/m]; empty in a scene without foundation
std::vector<double> foundationSprings(const Scene& scene, const std::vector<double>& areas);

}  // namespace vibe
