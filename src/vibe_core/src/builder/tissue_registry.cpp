#include "vibe_core/builder/tissue_registry.hpp"

#include <algorithm>
#include <map>
#include <mutex>

#include "constraints/supports.hpp"
#include "dynamics/implicit_solver.hpp"
#include "dynamics/xpbd_solver.hpp"
#include "sparse/factor_plan.hpp"
#include "tissue/shape_matching.hpp"
#include "tissue/shell_tissue.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/tissue_choices.hpp"
#include "vibe_core/scene/words.hpp"

namespace vibe {

namespace {

constexpr const char* kKey = "tissue.model";
// Steps at least until a factor is used that has been begun. Design choice: what the default interval is at 60 Hz.
// Where steps are longer, a factor every second step takes more time than the steps, and its age hardly changes their
// error.
constexpr double kFactorSteps = 6;

TissueAndSolver makeShapeMatching(const TissueRequest& request) {
  const Scene& scene = request.scene;
  auto tissue = std::make_shared<const ShapeMatching>(request.organ, scene.tissue, request.masses, request.areas,
                                                      scene.step_period, request.min_substeps);
  return {tissue, std::make_shared<const XpbdSolver>(tissue), tissue->substeps()};
}

ElasticBody shellBody(const TissueRequest& request) {
  const Scene& scene = request.scene;
  ElasticBody body;
  body.fixed = attachedNodes(scene, request.organ);
  body.rest.assign(request.organ.surface.vertices.begin(), request.organ.surface.vertices.end());
  body.mass = request.masses;
  body.foundation = foundationSprings(scene, request.areas);
  const bool carried = scene.foundation && scene.foundation->carries_weight;
  if (scene.gravity && !carried) body.gravity = scene.gravity->acceleration;
  body.mass_damping = scene.tissue.mass_damping;
  body.stiffness_damping = scene.tissue.stiffness_damping;
  return body;
}

TissueAndSolver makeShell(const TissueRequest& request) {
  const Scene& scene = request.scene;
  ElasticBody body = shellBody(request);
  auto tissue = std::make_shared<const ShellTissue>(scene.tissue, request.organ, body.fixed, scene.motion);
  body.elements = tissue->elements();
  body.shell = tissue->elements().get();
  StepSettings settings;
  settings.step = scene.step_period;
  settings.iterations = scene.tissue.iterations;
  settings.spectral_radius = scene.tissue.spectral_radius;
  settings.refactor_interval = std::max(settings.refactor_interval, kFactorSteps * settings.step);
  settings.factor_rate = kFactorRate;
  return {tissue, std::make_shared<const ImplicitSolver>(tissue->elements(), std::move(body), settings)};
}

struct Registry {
  std::mutex mutex;
  std::map<std::string, TissueFactory> factories;
};

Registry& registry() {
#define VIBE_FACTORY(name, word, meaning) {#word, make##name},
  static Registry registry{{}, {VIBE_TISSUE_MODELS(VIBE_FACTORY)}};
#undef VIBE_FACTORY
  return registry;
}

/// An empty function for an unknown name.
TissueFactory factoryOf(const std::string& name) {
  Registry& all = registry();
  const std::lock_guard<std::mutex> lock(all.mutex);
  const auto factory = all.factories.find(name);
  return factory == all.factories.end() ? TissueFactory() : factory->second;
}

}  // namespace

std::vector<std::string> tissueModelNames() {
  std::vector<std::string> names;
  for (const Choice& choice : choicesOf(kKey)) names.push_back(choice.word);
  return names;
}

void registerTissueModel(const std::string& name, const std::string& meaning, TissueFactory factory) {
  if (!factory) throw Error("tissue model '" + name + "': there is no factory; pass one");
  Registry& all = registry();
  const std::lock_guard<std::mutex> lock(all.mutex);
  addChoice(kKey, {name, meaning});
  all.factories.emplace(name, std::move(factory));
}

TissueAndSolver makeTissue(const Scene& scene, const Organ& organ, const std::vector<double>& masses,
                           const std::vector<double>& areas, int min_substeps) {
  const TissueFactory factory = factoryOf(scene.tissue.model);
  if (!factory)
    throw Error(std::string(kKey) + " '" + scene.tissue.model + "' is unknown; " +
                suggestKey(scene.tissue.model, tissueModelNames()));
  return factory({scene, organ, masses, areas, min_substeps});
}

ElasticBody wallBody(const Model& model) {
  const auto* tissue = dynamic_cast<const ShellTissue*>(model.tissue.get());
  if (tissue == nullptr)
    throw Error("The tissue of '" + model.scene.name + "' has no elements; give it tissue.model: shell.");
  ElasticBody body = shellBody({model.scene, model.organ, model.mass, model.area});
  body.elements = tissue->elements();
  body.shell = tissue->elements().get();
  return body;
}

}  // namespace vibe
