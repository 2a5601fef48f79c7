#pragma once

#include <memory>

#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/simulation/simulation.hpp"
#include "vibe_testing/whole_bite.hpp"

namespace vibe::hardware {

/// The default scene; with fewer particles, so that a bite takes three seconds of computing.
inline std::shared_ptr<const Model> coarseStomach() {
  static const auto model = [] {
    Scene scene = loadScene("../../vibe_core/scenes/stomach.yaml");
    scene.geometry.particles = 1000;
    return buildModel(scene, readTextFile("../../vibe_description/urdf/scope.urdf", "URDF"));
  }();
  return model;
}

/// A hand whose device drives the simulator, in simulated time and without ROS.
class SimulatedStomach : public test::HandAtDevice {
 public:
  test::SeenByHand look() override {
    act();
    frame();
    return seen_;
  }

 protected:
  Simulation simulation_{coarseStomach(), SimulationSettings::study(1)};

  double stepPeriod() const { return simulation_.stepPeriod(); }  ///< [s]

  /// What the hand does now; may let frames pass.
  virtual void act() = 0;
  /// What the device sends in a step.
  virtual StepInput send() = 0;
  /// After a step.
  virtual void hear() {}

  void frame() {
    const StepInput input = send();
    if (input.joints != last_.joints || input.buttons != last_.buttons) ++commands;
    last_ = input;
    for (const Event& event : simulation_.step(input)) {
      ++seen_.events[static_cast<std::size_t>(event.kind)];
      if (event.kind == Event::Kind::GrabMissed) seen_.gap = event.value;
    }
    seen_.time = simulation_.time();
    seen_.joints = simulation_.state().joints;
    seen_.force = simulation_.state().tool_force.norm();
    hear();
  }

 private:
  test::SeenByHand seen_;
  StepInput last_;
};

}  // namespace vibe::hardware
