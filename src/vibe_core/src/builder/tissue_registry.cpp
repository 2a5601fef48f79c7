#include "vibe_core/builder/tissue_registry.hpp"

#include "constraints/attachment.hpp"
#include "constraints/foundation.hpp"
#include "dynamics/implicit_solver.hpp"
#include "dynamics/xpbd_solver.hpp"
#include "tissue/shape_matching.hpp"
#include "tissue/shell_tissue.hpp"
#include "vibe_core/common/error.hpp"

namespace vibe {

namespace {

using Factory = TissueAndSolver (*)(Scene&, const Organ&, const std::vector<double>&, const std::vector<double>&, int);

TissueAndSolver makeShapeMatching(Scene& scene, const Organ& organ, const std::vector<double>& masses,
                                  const std::vector<double>& areas, int at_least) {
  auto tissue = std::make_shared<const ShapeMatching>(organ, scene.tissue, masses, areas, scene.step_period, at_least);
  scene.tissue.substeps = tissue->substeps();
  return {tissue, std::make_shared<const XpbdSolver>(tissue)};
}

TissueAndSolver makeShell(Scene& scene, const Organ& organ, const std::vector<double>& masses,
                          const std::vector<double>& areas, int) {
  ElasticBody body;
  body.fixed = attachedNodes(scene, organ);
  auto tissue = std::make_shared<const ShellTissue>(scene.tissue, organ, body.fixed);
  body.elements = tissue->elements();
  body.shell = tissue->elements().get();
  body.rest.assign(organ.surface.vertices.begin(), organ.surface.vertices.end());
  body.mass = masses;
  body.foundation = foundationSprings(scene, areas);
  const bool carried = scene.foundation && scene.foundation->carries_weight;
  if (scene.gravity && !carried) body.gravity = scene.gravity->acceleration;
  body.mass_damping = scene.tissue.mass_damping;
  body.stiffness_damping = scene.tissue.stiffness_damping;
  StepSettings settings;
  settings.step = scene.step_period;
  settings.iterations = scene.tissue.iterations;
  settings.spectral_radius = scene.tissue.spectral_radius;
  return {tissue, std::make_shared<const ImplicitSolver>(tissue->elements(), std::move(body), settings)};
}

struct Entry {
  const char* name;
  Factory make;
};

// A new tissue model is one line here, its own two files, and a test.
constexpr Entry kEntries[] = {{"shape_matching", makeShapeMatching}, {"shell", makeShell}};

}  // namespace

std::vector<std::string> tissueModelNames() {
  std::vector<std::string> names;
  for (const Entry& entry : kEntries) names.emplace_back(entry.name);
  return names;
}

TissueAndSolver makeTissue(Scene& scene, const Organ& organ, const std::vector<double>& masses,
                           const std::vector<double>& areas, int at_least) {
  std::string known;
  for (const Entry& entry : kEntries) {
    if (scene.tissue.model == entry.name) return entry.make(scene, organ, masses, areas, at_least);
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
  }
  throw Error("tissue.model '" + scene.tissue.model + "' is unknown; use one of: " + known + ".");
}

}  // namespace vibe
