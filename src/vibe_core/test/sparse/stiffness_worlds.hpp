#pragma once

#include <memory>
#include <string>

#include "constraints/attachment.hpp"
#include "constraints/foundation.hpp"
#include "solver/factor_schedule.hpp"
#include "solver/implicit_worlds.hpp"
#include "tissue/shell_tissue.hpp"
#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/scene/scene_parser.hpp"

/// Stiffness matrices as the implicit solver factors them.
namespace vibe::test {

/// The wall of the organ of a scene with tissue.model: shell, as a solver sees it.
inline ElasticBody stomachBody(const std::string& scene_file) {
  Scene scene = loadScene(scene_file);
  scene.scope.reset(), scene.helix.reset(), scene.suture.reset(), scene.bleeding.reset(), scene.marking.reset();
  const auto made = buildModel(scene, "");
  const Model& model = *made;
  const auto& tissue = dynamic_cast<const ShellTissue&>(*model.tissue);
  ElasticBody body;
  body.elements = tissue.elements();
  body.rest.assign(model.organ.surface.vertices.begin(), model.organ.surface.vertices.end());
  body.mass = model.mass;
  body.fixed = attachedNodes(model.scene, model.organ);
  body.foundation = foundationSprings(model.scene, model.area);
  return body;
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
