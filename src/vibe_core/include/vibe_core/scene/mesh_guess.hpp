#pragma once
#include <string>

#include "vibe_core/scene/scene.hpp"

namespace vibe {

/// Uses a surface file about which nothing else is known: applyMeshOverride() if the sidecar or the scene states
/// landmarks; otherwise unit, axes and landmarks are guessed and reported.
///   unit       metre, centimetre, millimetre or inch, whichever gives the most likely size of an organ
///   axes       glTF: y up, z to the front (Khronos 2021, section 3.4); others: x left, y back, z up (DICOM)
///   landmarks  estimateLandmarks()
/// @return the guesses, as the text of a sidecar file that states them; empty if nothing was guessed
/// @throws Error like applyMeshOverride() and importMesh()
std::string useMesh(Scene& scene, const std::string& mesh_file);

}  // namespace vibe
