#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "vibe_vision/synthetic/renderer.hpp"
#include "vibe_vision/synthetic/synthetic_scene.hpp"

namespace vibe::vision::evidence {

/// What to measure: a scene and how it differs from the standard one.
struct Cell {
  std::string scene;   ///< of sceneNames() or harderScenes()
  double marker = 40;  ///< side of the tags and outer diameter of the ring [px]; the sleeve goes with it
  std::optional<double> exposure = {};  ///< instead of the scene's [s]
  int width = 0, height = 0;            ///< of the sensor [px]; 0: the scene's
};

/// A scene with four markers on axes of their own, side by side in every frame: sleeve, ring, ArUco, AprilTag.
struct BenchScene {
  SyntheticScene scene;
  VisionConfig config;                                        ///< of sleeve and ring only
  std::size_t sleeve = 0, ring = 0, aruco = 0, apriltag = 0;  ///< indices into scene.instruments
};

/// @throws Error for an unknown scene
BenchScene makeBenchScene(const Cell& cell, std::uint64_t seed);
/// Copies the pixels of a frame, which frames share. @return they may be changed
std::uint8_t* ownPixels(Frame& frame);
/// A larger sensor around the same picture.
void enlarge(SyntheticScene& scene, int width, int height);
/// Sizes, exposures and sensors of the whole table.
std::vector<Cell> furtherCells();

/// A scene beyond the standard ones, of conditions that no parameter was chosen for: one of those, changed. `seed`
/// varies what a scene may vary.
struct HarderScene {
  std::string name;
  std::string base;  ///< of sceneNames()
  std::function<void(SyntheticScene&, std::uint64_t seed)> change;
  std::function<void(const SyntheticScene&, RenderedFrame&)> retouch;  ///< of every frame and its truth; may be empty
};

const std::vector<HarderScene>& harderScenes();
/// Scenes in which something is wrong with the marker, the picture or what is said of it.
const std::vector<HarderScene>& faultyScenes();
/// Of both kinds.
/// @return null for a standard scene
const HarderScene* findHarderScene(const std::string& name);

}  // namespace vibe::vision::evidence
