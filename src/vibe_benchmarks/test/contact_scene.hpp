#pragma once
#include <string>

#include "vibe_core/files/files.hpp"
#include "vibe_core/scene/scene_parser.hpp"

namespace vibe::benchmarks::test {

/// The default stomach with 900 particles and gas that fills it within a second.
inline Scene coarseStomach() {
  Scene scene = loadScene(VIBE_CORE_DIR "/scenes/stomach.yaml");
  scene.geometry.particles = 900;
  scene.gas->flow_limit = 5e-4;
  scene.render_surface = false;
  return scene;
}

inline std::string scopeUrdf() {
  return readTextFile(VIBE_DESCRIPTION_DIR "/urdf/scope.urdf", "URDF");
}

}  // namespace vibe::benchmarks::test
