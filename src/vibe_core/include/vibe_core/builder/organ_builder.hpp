#pragma once
#include "vibe_core/common/progress.hpp"
#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/scene/scene.hpp"

namespace vibe {

/// Builds the organ that a scene asks for: procedural, imported or a plain sphere, remeshed to exactly
/// scene.geometry.particles vertices, with regions, walls, ends and thickness per vertex. The centre of the enclosed
/// volume is the origin. The entry of a procedural stomach is the centre of the rim of the dome that closes the
/// oesophagus; that of an imported one is the surface point nearest to its oesophagus landmark, and the axis the
/// direction in which a straight scope of 6 mm radius gets farthest. A relative geometry.file is beside the scene file.
/// Deterministic. Takes up to some tens of seconds for an imported mesh; reports progress.
/// @throws Error if the surface cannot be used (file, hole, orientation, size ...).
Organ buildOrgan(const Scene& scene, const Progress& progress = {});

}  // namespace vibe
