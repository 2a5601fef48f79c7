#pragma once
#include "vibe_sim/geometry/organ.hpp"
#include "vibe_sim/progress.hpp"
#include "vibe_sim/scene/scene.hpp"

namespace vibe {

/// Builds the organ that a scene asks for: procedural, imported or a plain sphere, remeshed to exactly
/// scene.geometry.particles vertices, with regions, walls, ends and thickness per vertex.
/// Deterministic. Takes up to some tens of seconds for an imported mesh; reports progress.
/// @throws Error if the surface cannot be used (file, hole, orientation, size ...).
Organ buildOrgan(const Scene& scene, const Progress& progress = {});

}  // namespace vibe
