#include "vibe_core/procedure/procedure_registry.hpp"

#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "vibe_core/model/model.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/words.hpp"

namespace vibe {

namespace {

/// What other packages have registered under words of a scene key with an open list. Safe to use from any thread.
template <class Thing>
class WordRegistry {
 public:
  explicit WordRegistry(const char* key) : key_(key) {}

  /// @throws Error if the word is not usable, see addChoice(), or nothing is behind it
  void add(const std::string& word, const std::string& meaning, Thing thing) {
    if (!thing)
      throw Error(std::string(key_) + ": nothing is behind '" + word + "'; pass a model or a factory that is not null");
    const std::lock_guard<std::mutex> lock(mutex_);
    addChoice(key_, {word, meaning});
    things_.emplace(word, std::move(thing));
  }

  /// Empty for a word of the library itself. @throws Error for a word that is not known, see checkChoice()
  Thing find(const std::string& word) const {
    checkChoice(key_, word);
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = things_.find(word);
    return found == things_.end() ? Thing() : found->second;
  }

 private:
  const char* key_;
  mutable std::mutex mutex_;
  std::map<std::string, Thing> things_;
};

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
