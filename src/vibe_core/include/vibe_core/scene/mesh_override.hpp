#pragma once
#include <string>

#include "vibe_core/scene/scene.hpp"

namespace vibe {

/// The file with the information that a surface file cannot contain: "stomach.glb" -> "stomach.glb.landmarks.yaml".
std::string sidecarOf(const std::string& mesh_file);

/// Replaces the organ of a scene by an imported surface, keeping its particle count and everything else.
/// Unit, rotation, target volume and landmarks come from the sidecar file if it states them, otherwise from the scene.
/// @return whether there was a sidecar
/// @throws Error if the file is missing, the sidecar is wrong, or the unit or landmarks are stated nowhere
bool applyMeshOverride(Scene& scene, const std::string& mesh_file);

}  // namespace vibe
