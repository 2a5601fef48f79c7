#pragma once
#include <functional>
#include <string>
#include <vector>

#include "bench_scene.hpp"
#include "vibe_vision/synthetic/renderer.hpp"

namespace vibe::vision {

/// A scene beyond the standard ones: one of those, changed. `seed` varies what a scene may vary.
struct HarderScene {
  std::string name;
  std::string base;  ///< of sceneNames()
  std::function<void(SyntheticScene&, std::uint64_t seed)> change;
  std::function<void(const SyntheticScene&, RenderedFrame&)> retouch;  ///< of every frame and its truth; may be empty
};

const std::vector<HarderScene>& harderScenes();
/// @return null for a standard scene
const HarderScene* findHarderScene(const std::string& name);

}  // namespace vibe::vision
