#include "scene_source.hpp"

#include <ros/console.h>

#include "vibe_core/common/package_path.hpp"
#include "vibe_core/scene/mesh_guess.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/simulation/simulator.hpp"

namespace vibe {
namespace {

std::shared_ptr<const Model> build(const Scene& scene) {
  const std::string urdf = scene.scope ? readTextFile(resolveAddress(scene.scope->urdf), "URDF") : "";
  return buildModel(scene, urdf, [](const std::string& what, double fraction) {
    ROS_DEBUG_STREAM(what << ": " << static_cast<int>(100 * fraction) << " %");
  });
}

}  // namespace

std::shared_ptr<const Model> loadModel(const std::string& scene_address, const std::string& mesh_address) {
  Scene scene = loadScene(resolveAddress(scene_address));
  const std::string guesses = mesh_address.empty() ? "" : useMesh(scene, resolveAddress(mesh_address));
  if (!guesses.empty()) ROS_WARN_STREAM(guesses);
  std::shared_ptr<const Model> model = build(scene);
  const std::string softness = softnessWarning(*model);
  if (!softness.empty()) ROS_WARN_STREAM(softness);
  return model;
}

std::shared_ptr<const Model> modelOfText(const std::string& text, const std::string& place) {
  return build(parseScene(text, place));
}

}  // namespace vibe
