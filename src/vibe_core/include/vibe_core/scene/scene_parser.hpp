#pragma once

#include <string>

#include "vibe_core/scene/scene.hpp"

namespace vibe {

/// Reads and validates a scene file (format: docs/scenes.md), on top of the scene that its key `base` names. Paths in
/// it are relative to the file; in the result they lead from the working directory, and geometry.file is absolute.
/// @throws Error "file:line: key: what is wrong; remedy" for anything the schema does not allow, or a missing file
Scene loadScene(const std::string& file);

/// The same from text; files that the scene names need not exist.
/// @param place  what to call the text in errors; its folder is where relative paths start
Scene parseScene(const std::string& yaml, const std::string& place);

/// The scene as YAML that parseScene() reads back to equal values: every key with plain SI numbers.
std::string toYaml(const Scene& scene);

/// The file with the information that a surface file cannot contain: "stomach.glb" -> "stomach.glb.landmarks.yaml".
std::string sidecarOf(const std::string& mesh_file);

/// Replaces the organ of a scene by an imported surface, keeping its particle count and everything else.
/// Unit, rotation, target volume and landmarks come from the sidecar file if it states them, otherwise from the scene.
/// @return whether there was a sidecar
/// @throws Error if the file is missing, the sidecar is wrong, or the unit or landmarks are stated nowhere
bool applyMeshOverride(Scene& scene, const std::string& mesh_file);

/// Uses a surface file about which nothing else is known: applyMeshOverride() if the sidecar or the scene states
/// landmarks; otherwise unit, axes and landmarks are guessed and reported.
///   unit       of all that scenes know, that which makes the surface most like a stomach by volume and mass of its
///   wall axes       glTF: y up, z to the front (Khronos 2021, section 3.4); others: as 3D Slicer states them in the
///   file,
///              else x left, y back, z up (DICOM)
///   landmarks  from the shape; geometry.landmark_confidence says how sure they are, from 0 (nothing like a stomach) to
///              1 (like a stomach in every respect, and the same places are found when the axes are tilted by 20
///              degrees); a guessed unit with which the volume, the wall or the length are not a stomach's lowers it
/// @return the guesses and how sure they are, as the text of a sidecar file that states them, and one sentence more for
///         the unit and for the landmarks if they are not to be relied on; empty if nothing was guessed
/// @throws Error like applyMeshOverride() and importMesh(), and for a surface that is nothing like a stomach
std::string useMesh(Scene& scene, const std::string& mesh_file);

/// "landmarks          guessed, confidence 0.83" and a newline, for the summary of a session; empty if they are stated.
std::string landmarkRemark(const Scene& scene);

}  // namespace vibe
