#pragma once

#include "vibe_testing/scope_fixture.hpp"
#include "vibe_testing/worlds.hpp"

/// A ball around the origin that stands in for the organ, with the endoscope entering at its top and looking down.
namespace vibe::test {

/// The endoscope at the top of a ball of this radius [m]; insertion leads down.
inline ScopeScene scopeFromAbove(double radius) {
  ScopeScene scope;
  scope.base_from_anatomy = false;
  scope.base_position = Eigen::Vector3d(0, 0, radius);
  scope.base_rpy = {0, M_PI / 2, 0};  // x down
  return scope;
}

/// A shell on a stiff foundation, without gas and weight, and the scope above it.
inline Scene shellUnderScope(double radius) {
  Scene scene;
  scene.tissue.model = "shell";
  scene.tissue.mass_damping = 30;
  scene.tissue.self_contact = false;
  scene.gas.reset();
  scene.gravity.reset();
  scene.foundation = FoundationScene{};
  scene.foundation->stiffness = 2e5;
  scene.scope = scopeFromAbove(radius);
  return scene;
}

/// A helix that holds with all of its force from the first touch.
inline HelixScene firmHelix() {
  HelixScene helix;
  helix.hold_turns = 0;
  return helix;
}

/// The same for coarse meshes: it reaches farther and holds more.
inline HelixScene wideHelix() {
  HelixScene helix = firmHelix();
  helix.reach = 8e-3;
  helix.grip_radius = 10e-3;
  return helix;
}

/// @param level      of icosphere()
/// @param open_from  the scope passes through the surface above this part of the radius
inline Organ openBall(double radius, int level, double thickness, double open_from = 0.85) {
  Organ organ = plainOrgan(icosphere(radius, level), thickness);
  for (std::size_t i = 0; i < organ.end.size(); ++i)
    if (organ.surface.vertices[i].z() > open_from * radius) organ.end[i] = End::Oesophagus;
  return organ;
}

/// A simulator with the endoscope of scopeText().
inline World scopeWorld(const Scene& scene, Organ organ) {
  return World(scene, std::move(organ), scopeText());
}

/// Where the scope is, how far the helix is out, and whether it grabs.
inline StepInput scopeAt(double insertion, double helix_advance = 0, bool grab = false) {
  StepInput input;
  input.joints[Insertion] = insertion;
  input.joints[HelixAdvance] = helix_advance;
  input.buttons[HelixGrab] = grab ? 1 : 0;
  return input;
}

/// Mean place of what the helix holds [m].
inline Eigen::Vector3d heldPlace(const World& world) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const GripPoint& point : world.state.grip) sum += point.weight * world.position(point.particle);
  return sum;
}

}  // namespace vibe::test
