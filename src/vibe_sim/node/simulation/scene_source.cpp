#include "simulation/scene_source.hpp"

#include <utility>

#include <ros/console.h>

#include "vibe_core/files/files.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/simulation/simulator.hpp"

namespace vibe::sim {

namespace {

SceneModel build(const Scene& scene, std::string urdf) {
  if (urdf.empty() && scene.scope) urdf = readTextFile(resolveAddress(scene.scope->urdf), "URDF");
  auto model = buildModel(scene, urdf, [](const std::string& what, double fraction) {
    ROS_DEBUG_STREAM(what << ": " << static_cast<int>(100 * fraction) << " %");
  });
  return {std::move(model), std::move(urdf)};
}

}  // namespace

SceneModel loadModel(const std::string& scene_address, const std::string& mesh_address) {
  Scene scene = loadScene(resolveAddress(scene_address));
  const std::string guesses = mesh_address.empty() ? "" : useMesh(scene, resolveAddress(mesh_address));
  if (!guesses.empty()) ROS_WARN_STREAM(guesses);
  SceneModel made = build(scene, "");
  for (const std::string& warning : warningsAbout(*made.model)) ROS_WARN_STREAM(warning);
  return made;
}

SceneModel modelOfText(const std::string& text, const std::string& place, const std::string& urdf) {
  return build(parseScene(text, place), urdf);
}

}  // namespace vibe::sim
