#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <vector>

#include "procedure/needle.hpp"
#include "procedure/procedure.hpp"
#include "vibe_core/arithmetic/rotation.hpp"
#include "vibe_testing/scope_worlds.hpp"

namespace vibe::test {

constexpr double kBenchRadius = 0.03;
constexpr double kBenchThickness = 2e-3;

/// A ball with everything that a procedure needs and nothing else.
inline Scene benchScene() {
  Scene scene = bareScene();
  scene.foundation = FoundationScene{};
  scene.scope = ScopeScene{};
  scene.scope->base_from_anatomy = false;
  scene.helix = HelixScene{};
  scene.suture = SutureScene{};
  return scene;
}

/// The procedure without tissue that moves: commands go to a wall that stays where it is, the device is put where the
/// test wants it.
struct Bench {
  World world;
  Eigen::Vector3d site = Eigen::Vector3d::UnitX();  ///< unit, where on the ball the needle goes in
  double beyond =
      2e-3;  ///< of the needle's point at its deepest, from the mid-surface at a vertex, positive outside [m]
  StepInput input;
  std::vector<Event> events;  ///< of the last act

  explicit Bench(const Scene& scene = benchScene(), int level = 2)
      : world(scene, plainOrgan(icosphere(kBenchRadius, level), kBenchThickness), scopeText()) {}

  State& state() { return world.state; }
  ProcedureState& procedure() { return world.state.procedure; }
  const Model& model() const { return *world.model; }

  /// Vertex number k of the ball becomes the site.
  void goTo(int vertex) { site = world.model->organ.surface.vertices[vertex].normalized(); }

  /// Poses with the needle's path pointing at the middle of the ball, its outer end `beyond` the site.
  std::vector<Eigen::Isometry3d> poses() const {
    std::vector<Eigen::Isometry3d> poses;
    model().tool->forwardKinematics(world.state.joints, poses);
    const auto [begin, end] = needlePath(model(), poses);
    Eigen::Isometry3d base = Eigen::Isometry3d::Identity();
    base.linear() = rotationBetween(begin - end, site).toRotationMatrix();
    base.translation() = (kBenchRadius + beyond) * site - base.linear() * begin;
    for (Eigen::Isometry3d& pose : poses) pose = base * pose;
    return poses;
  }

  /// One step of the procedure with the present input.
  void act() {
    events.clear();
    commandProcedure(model(), poses(), input, state(), {state(), events});
    ++state().step;
    state().time = static_cast<double>(state().step) * model().scene.step_period;
    updateProcedure(model(), state(), {state(), events});
    world.events.insert(world.events.end(), events.begin(), events.end());
  }

  void moveArm(double part) {
    state().joints[NeedleDriver] = part * model().tool->limits()[NeedleDriver].upper;
    act();
  }
  void closeArm() { moveArm(1); }
  void closeInAir() {
    const double before = beyond;
    beyond = -5e-3;
    moveArm(1);
    beyond = before;
  }
  void openArm() { moveArm(0); }

  void hold(Button button, bool down = true) {
    input.buttons[button] = down ? 1 : 0;
    act();
  }
  /// Down for one step and up again; events: of the step in which it went down.
  void press(Button button) {
    hold(button);
    const std::vector<Event> pressed = events;
    hold(button, false);
    events = pressed;
  }

  /// A whole bite at a vertex, the needle back on the open arm afterwards.
  void bite(int vertex) {
    goTo(vertex);
    closeArm();
    press(Needle);
    openArm();
    closeInAir();
    press(Needle);
    openArm();
  }

  int count(Event::Kind kind) const {
    int n = 0;
    for (const Event& event : events) n += event.kind == kind ? 1 : 0;
    return n;
  }
  std::string refusal() const {
    for (const Event& event : events)
      if (event.kind == Event::Kind::Rejected) return describe(event);
    return "";
  }
};

/// From wherever the procedure stands: what a trainee does to come to a cinched set.
inline void finishOneSet(Bench& bench) {
  bench.input = {};
  bench.act();
  const auto active = [&] {
    return !bench.procedure().sutures.empty() && !bench.procedure().sutures.back().permanent();
  };
  if (bench.procedure().needle_loaded) {
    bench.openArm();
    if (!bench.procedure().needle_on_arm) {
      bench.closeInAir();
      bench.press(Needle);
      bench.openArm();
    }
    const int first = active() ? static_cast<int>(bench.procedure().sutures.back().bites.size()) : 0;
    for (int k = first; k < bench.model().scene.suture->min_bites; ++k) bench.bite(k);
    bench.press(TTag);
  }
  bench.press(Cinch);
}

}  // namespace vibe::test
