#pragma once

#include <memory>
#include <string>

#include "solver/factor_schedule.hpp"
#include "solver/implicit_worlds.hpp"
#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/builder/tissue_registry.hpp"
#include "vibe_core/scene/scene_parser.hpp"

/// Stiffness matrices as the implicit solver factors them.
namespace vibe::test {

/// The wall of the organ of a scene with tissue.model: shell, as a solver sees it.
inline ElasticBody stomachBody(const std::string& scene_file) {
  Scene scene = loadScene(scene_file);
  scene.scope.reset(), scene.helix.reset(), scene.suture.reset(), scene.bleeding.reset(), scene.marking.reset();
  return wallBody(*buildModel(scene, ""));
}

/// Stiffness at rest with the inertia of a step of 1/60 s.
inline BlockMatrix stiffnessOf(const ElasticBody& body) {
  constexpr double kInertia = 3600;  // [1/s^2]
  BlockMatrix matrix(std::make_shared<BlockPattern>(blockPattern(body.nodeCount(), body.elements->nodeGroups())));
  Factor factor(makeFactorPlan(matrix.pattern()));
  if (!factorAt(body, {}, kInertia, 1, matrix, factor)) matrix.setZero();
  return matrix;
}

}  // namespace vibe::test
