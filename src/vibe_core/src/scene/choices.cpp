#include "vibe_core/scene/choices.hpp"

#include <map>
#include <mutex>

#include "vibe_core/common/error.hpp"
#include "vibe_core/scene/material_law_list.hpp"
#include "vibe_core/scene/tissue_model_list.hpp"

namespace vibe {
namespace {

struct Lists {
  std::mutex mutex;
  std::map<std::string, std::vector<Choice>> of_key;
};

Lists& lists() {
#define VIBE_CHOICE(name, word, meaning) {#word, meaning},
  static Lists lists{
      {}, {{"tissue.law", {VIBE_MATERIAL_LAWS(VIBE_CHOICE)}}, {"tissue.model", {VIBE_TISSUE_MODELS(VIBE_CHOICE)}}}};
#undef VIBE_CHOICE
  return lists;
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

void addChoice(const std::string& key, const Choice& choice) {
  Lists& all = lists();
  const std::lock_guard<std::mutex> lock(all.mutex);
  const auto list = all.of_key.find(key);
  if (list == all.of_key.end()) throw Error(key + ": takes no words of other packages; use tissue.law or tissue.model");
  if (!isWord(choice.word))
    throw Error(key + ": '" + choice.word + "' is not a name for it; use small letters, digits and '_'");
  for (const Choice& known : list->second)
    if (known.word == choice.word) throw Error(key + ": '" + choice.word + "' exists already; choose another name");
  list->second.push_back(choice);
}

}  // namespace vibe
