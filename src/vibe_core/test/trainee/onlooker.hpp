#pragma once
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "trainee/operator.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/simulation/simulation.hpp"

namespace vibe {

/// A stomach with all that a trainee works with, at rest.
inline std::shared_ptr<const Model> smallStomach() {
  static const std::shared_ptr<const Model> model = [] {
    Scene scene;
    scene.geometry.particles = 2000;
    scene.attach_oesophagus = scene.attach_duodenum = true;
    scene.gas.emplace();
    scene.scope.emplace();
    scene.helix.emplace();
    scene.suture.emplace();
    return buildModel(scene, readTextFile(std::string(VIBE_DESCRIPTION_DIR) + "/urdf/scope.urdf", "URDF"));
  }();
  return model;
}

/// A trainee's knowledge before it does anything, looking at the organ at rest. Nothing is simulated: what it sees
/// changes only by `after`, which is called at the end of each step.
struct Onlooker {
  explicit Onlooker(const Skill& given = Skill::expert(), std::function<void(Observation&)> after = {})
      : skill(given), hand(*smallStomach(), skill, [this, after] {
          ++steps;
          seen.time += smallStomach()->scene.step_period;
          if (after) after(seen);
          hand.perceive(seen);
        }) {
    hand.perceive(seen);
    me.map();
  }

  Observation seen = observe(Simulation(smallStomach()));
  Skill skill;
  int steps = 0;  // that the hand has let pass
  TraineeHand hand;
  Operator me{hand, 1, [](const std::string&) {}, {}};
};

}  // namespace vibe
