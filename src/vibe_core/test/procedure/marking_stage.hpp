#pragma once
#include <algorithm>
#include <cmath>

#include "vibe_testing/scope_worlds.hpp"

/// A stage for the argon beam in whole steps.
namespace vibe::test {

constexpr double kStageRadius = 0.058, kStageWall = 2e-3, kStageGap = 3e-3;

/// A ball on a foundation at rest; the scope enters at the top and looks down.
inline Scene markingScene() {
  Scene scene;
  scene.tissue.model = "shell";
  scene.foundation = FoundationScene{};
  scene.scope = test::scopeFromAbove(kStageRadius);
  scene.marking = MarkingScene{};
  return scene;
}

struct MarkingStage : World {
  StepInput input;

  /// @param gap  from the probe's end to the mucosa at the bottom [m]
  explicit MarkingStage(const Scene& scene = markingScene(), double gap = kStageGap, int level = 4)
      : World(scopeWorld(scene, openBall(kStageRadius, level, kStageWall, 0.8))) {
    placeTip(gap);
    state.joints = input.joints;
    input.buttons[ApcPedal] = 1;
  }

  void placeTip(double gap) {
    input.joints[Insertion] = 2 * kStageRadius - kStageWall / 2 - gap - ApcParameters{}.probe_length;
  }
  void press(double seconds) {
    input.buttons[ApcPedal] = 1;
    run(seconds, input);
  }
  void release(double seconds) {
    input.buttons[ApcPedal] = 0;
    run(seconds, input);
  }
  int graded(BurnGrade min) const {
    int n = 0;
    for (const std::uint8_t grade : state.procedure.grade) n += grade >= static_cast<std::uint8_t>(min) ? 1 : 0;
    return n;
  }
  float hottest() const { return *std::max_element(state.procedure.heat.begin(), state.procedure.heat.end()); }
  float maxDose() const { return *std::max_element(state.procedure.dose.begin(), state.procedure.dose.end()); }
};

}  // namespace vibe::test
