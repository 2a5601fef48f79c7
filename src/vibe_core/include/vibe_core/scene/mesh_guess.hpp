#pragma once
#include <string>

#include "vibe_core/scene/scene.hpp"

namespace vibe {

/// For users who have nothing but a surface file: applyMeshOverride() where the sidecar or the scene states landmarks,
/// else guesses unit, axes and landmarks and says so.
///   unit       the one of metre, centimetre, millimetre, inch that gives the likeliest size of an organ
///   axes       glTF: y up, z to the front (Khronos 2021, section 3.4); others: x left, y back, z up (DICOM)
///   landmarks  estimateLandmarks()
/// @return empty, or a text for people: what was guessed, as the sidecar file that would state it
/// @throws Error like applyMeshOverride() and importMesh()
std::string useMesh(Scene& scene, const std::string& mesh_file);

}  // namespace vibe
