#pragma once
#include <string>

#include "vibe_core/scene/scene.hpp"

namespace vibe {

/// Uses a surface file about which nothing else is known: applyMeshOverride() if the sidecar or the scene states
/// landmarks; otherwise unit, axes and landmarks are guessed and reported.
///   unit       metre, centimetre, millimetre or inch, whichever gives the most likely size of an organ
///   axes       glTF: y up, z to the front (Khronos 2021, section 3.4); others: x left, y back, z up (DICOM)
///   landmarks  from the shape; geometry.landmark_confidence says how sure they are, from 0 (nothing like a stomach) to
///              1 (like a stomach in every respect, and the same places are found when the axes are tilted by 20
///              degrees)
/// @return the guesses and how sure they are, as the text of a sidecar file that states them, and one sentence more if
///         they are not to be relied on; empty if nothing was guessed
/// @throws Error like applyMeshOverride() and importMesh(), and for a surface that is nothing like a stomach
std::string useMesh(Scene& scene, const std::string& mesh_file);

/// "landmarks          guessed, confidence 0.83" and a newline, for the summary of a session; empty if they are stated.
std::string landmarkRemark(const Scene& scene);

}  // namespace vibe
