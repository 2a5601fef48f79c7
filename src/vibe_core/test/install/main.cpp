// Loads a scene that vibe_core installs, simulates a second and prints the state's hash.
#include <cstdio>
#include <exception>

#include "vibe_core/metrics/run_summary.hpp"
#include "vibe_core/simulation/simulation.hpp"

int main() {
  try {
    vibe::Simulation simulation(vibe::loadModel("package://vibe_core/scenes/sphere.yaml"));
    vibe::StepInput input;
    input.buttons[vibe::Insufflate] = 1;
    while (simulation.time() < 1) simulation.step(input);
    std::printf("%d particles, %.0f mL\n", simulation.model().particle_count, 1e6 * simulation.state().volume);
    std::printf("state hash: %s\n", vibe::toHex(simulation.hash()).c_str());
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
