// run_scene SCENE SECONDS: runs a scene without input and prints the hash of its last state, as vibe_headless does.
#include <cmath>
#include <cstdlib>
#include <exception>
#include <iostream>

#include "vibe_core/common/package_path.hpp"
#include "vibe_core/metrics/run_summary.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/simulation/simulator.hpp"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    const vibe::Scene scene = vibe::loadScene(vibe::resolveAddress(argv[1]));
    const std::string urdf = scene.scope ? vibe::readTextFile(vibe::resolveAddress(scene.scope->urdf), "URDF") : "";
    const auto model = vibe::buildModel(scene, urdf, {});
    vibe::State state = vibe::initialState(*model, scene.seed);
    vibe::Workspace workspace(*model, 1);
    std::vector<vibe::Event> events;
    for (long k = std::lround(std::atof(argv[2]) / scene.step_period); k > 0; --k)
      vibe::step(*model, state, vibe::StepInput{}, workspace, events);
    std::cout << "state hash: " << vibe::toHex(vibe::hash(state)) << "\n";
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "run_scene: " << error.what() << "\n";
    return 2;
  }
}
