#include "vibe_core/procedure/procedure_registry.hpp"
#include "scene/word_registry.hpp"
#include "vibe_core/model/model.hpp"

namespace vibe {

namespace {

WordRegistry<std::shared_ptr<const CinchModel>>& cinchModels() {
  static WordRegistry<std::shared_ptr<const CinchModel>> registry("suture.cinch_model");
  return registry;
}

WordRegistry<MarkingDeformationFactory>& markingDeformations() {
  static WordRegistry<MarkingDeformationFactory> registry("marking.deformation");
  return registry;
}

}  // namespace

void registerCinchModel(const std::string& name, const std::string& meaning, std::shared_ptr<const CinchModel> model) {
  cinchModels().add(name, meaning, std::move(model));
}

std::shared_ptr<const CinchModel> findCinchModel(const std::string& name) {
  return cinchModels().find(name);
}

void registerMarkingDeformation(const std::string& name, const std::string& meaning,
                                MarkingDeformationFactory factory) {
  markingDeformations().add(name, meaning, std::move(factory));
}

std::unique_ptr<MarkingDeformation> makeMarkingDeformation(const Model& model) {
  const MarkingDeformationFactory factory = markingDeformations().find(model.scene.marking->deformation);
  return factory ? factory(model) : nullptr;
}

}  // namespace vibe
