// Prints how the force on the tool grows with the insertion: press_curve STUDY.yaml, a file of this lab's own.
#include <cstdio>

#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/yaml_source.hpp"
#include "vibe_core/simulation/simulation.hpp"

namespace {

struct Study {
  std::string scene;
  double depth = 0;  ///< last insertion [m]
  double speed = 0;  ///< [m/s]
};

Study readStudy(const std::string& file) {
  const vibe::YamlSource source = vibe::YamlSource::load(file, {});
  Study study;
  for (const vibe::YamlField& field : source.map(source.root())) {
    if (field.key == "scene") {
      study.scene = source.text(field);
    } else if (field.key == "depth") {
      study.depth = source.quantity(field, "m", 0, 0.5);
    } else if (field.key == "speed") {
      study.speed = source.quantity(field, "m/s", 0.001, 0.5);
    } else {
      source.fail(field, "is not known; use scene, depth and speed");
    }
  }
  return study;
}

void press(const Study& study) {
  vibe::Simulation simulation(vibe::loadModel(study.scene));
  vibe::StepInput input;
  double max_force = 0;
  while (input.joints[vibe::Insertion] < study.depth) {
    input.joints[vibe::Insertion] += study.speed * simulation.stepPeriod();
    simulation.step(input);
    const double force = simulation.state().tool_force.norm();
    if (force > max_force) std::printf("%.4f m  %.3f N\n", input.joints[vibe::Insertion], max_force = force);
  }
  std::printf("max force: %.3f N\n", max_force);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc != 2) throw vibe::Error("usage: press_curve STUDY.yaml");
    press(readStudy(argv[1]));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "press_curve: %s\n", error.what());
    return 2;
  }
}
