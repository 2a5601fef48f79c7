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

}  // namespace vibe
