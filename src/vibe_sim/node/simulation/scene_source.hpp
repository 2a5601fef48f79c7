#pragma once

#include <memory>
#include <string>

#include "vibe_core/model/model.hpp"

namespace vibe::sim {

/// A model with the text of the URDF that its tool was made from; empty without a tool.
struct SceneModel {
  std::shared_ptr<const Model> model;
  std::string urdf;
};

/// Loads a scene with everything it names and builds its model; logs progress. Takes up to some tens of seconds.
/// @param scene_address, mesh_address  files or package:// addresses; an empty mesh keeps the organ of the scene
/// @throws Error
SceneModel loadModel(const std::string& scene_address, const std::string& mesh_address);

/// The model of a scene in the form in which the simulator publishes it.
/// @param place  where the text is from, for messages
/// @param urdf   text of the tool's URDF; empty: the file that the scene names
/// @throws Error
SceneModel modelOfText(const std::string& text, const std::string& place, const std::string& urdf = "");

}  // namespace vibe::sim
