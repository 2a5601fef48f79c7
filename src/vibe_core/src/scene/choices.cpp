#include "vibe_core/scene/choices.hpp"

#include <map>
#include <mutex>

#include "vibe_core/common/error.hpp"
#include "vibe_core/scene/material_law_list.hpp"
#include "vibe_core/scene/nearest_key.hpp"
#include "vibe_core/scene/tissue_model_list.hpp"

namespace vibe {
namespace {

struct Lists {
  std::mutex mutex;
  std::map<std::string, std::vector<Choice>> of_key;
};

Lists& lists() {
#define VIBE_CHOICE(name, word, meaning) {#word, meaning},
  static Lists lists{{},
                     {{"tissue.law", {VIBE_MATERIAL_LAWS(VIBE_CHOICE)}},
                      {"tissue.model", {VIBE_TISSUE_MODELS(VIBE_CHOICE)}},
                      {"suture.cinch_model", {{"thread", "the cinch shortens the thread"}}},
                      {"marking.deformation", {{"solver", "the tissue model, as at any other time"}}}}};
#undef VIBE_CHOICE
  return lists;
}

/// A word of a package that comes with the library but is loaded only where it is wanted.
struct Packaged {
  std::string key;
  Choice choice;
};

const std::vector<Packaged>& packaged() {
  static const std::vector<Packaged> all{
      {"suture.cinch_model", {"groups", "springs draw groups of particles together", "vibe_prototype"}},
      {"marking.deformation", {"gradient", "gradient-domain deformation, without forces", "vibe_prototype"}}};
  return all;
}

bool hasWord(const std::vector<Choice>& choices, const std::string& word) {
  for (const Choice& choice : choices)
    if (choice.word == word) return true;
  return false;
}

bool isWord(const std::string& text) {
  return !text.empty() && text.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos;
}

}  // namespace

std::vector<Choice> choicesOf(const std::string& key) {
  Lists& all = lists();
  const std::lock_guard<std::mutex> lock(all.mutex);
  const auto list = all.of_key.find(key);
  return list == all.of_key.end() ? std::vector<Choice>() : list->second;
}

std::vector<Choice> choicesNotLoaded(const std::string& key) {
  const std::vector<Choice> loaded = choicesOf(key);
  std::vector<Choice> others;
  for (const auto& [of, choice] : packaged())
    if (of == key && !hasWord(loaded, choice.word)) others.push_back(choice);
  return others;
}

std::string sayNotLoaded(const Choice& choice) {
  return "'" + choice.word + "' is in the package " + choice.package +
         ", which this program has not loaded; build it and set the environment variable VIBE_PLUGINS=lib" +
         choice.package + ".so";
}

void checkChoice(const std::string& key, const std::string& word) {
  const std::vector<Choice> loaded = choicesOf(key);
  if (hasWord(loaded, word)) return;
  for (const Choice& other : choicesNotLoaded(key))
    if (other.word == word) throw Error(key + ": " + sayNotLoaded(other));
  std::vector<std::string> words;
  for (const Choice& choice : loaded) words.push_back(choice.word);
  throw Error(key + ": '" + word + "' is not known here; " + suggestKey(word, words));
}

void addChoice(const std::string& key, const Choice& choice) {
  Lists& all = lists();
  const std::lock_guard<std::mutex> lock(all.mutex);
  const auto list = all.of_key.find(key);
  if (list == all.of_key.end()) throw Error(key + ": takes no words of other packages; use a key that does");
  if (!isWord(choice.word))
    throw Error(key + ": '" + choice.word + "' is not a name for it; use small letters, digits and '_'");
  if (hasWord(list->second, choice.word))
    throw Error(key + ": '" + choice.word + "' exists already; choose another name");
  list->second.push_back(choice);
}

}  // namespace vibe
