#pragma once
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/words.hpp"

namespace vibe {

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

}  // namespace vibe
