// run_scene SCENE SECONDS: runs a scene without input and prints the hash of its last state, as vibe_headless does.
#include <cmath>
#include <cstdlib>
#include <exception>
#include <iostream>

#include "vibe_core/metrics/session_report.hpp"
#include "vibe_core/simulation/simulation.hpp"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    vibe::Simulation simulation(vibe::loadModel(argv[1]));
    const long steps = std::lround(std::atof(argv[2]) / simulation.stepPeriod());
    simulation.run(steps, [](double) { return vibe::StepInput(); });
    std::cout << "state hash: " << vibe::toHex(simulation.hash()) << "\n";
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "run_scene: " << error.what() << "\n";
    return 2;
  }
}
