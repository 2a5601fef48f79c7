#include "vibe_core/scene/words.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <mutex>

#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/tissue_choices.hpp"

namespace vibe {

namespace {

/// Longer words come from broken files and are not compared, which would be slow.
constexpr std::size_t kLongestWord = 64;

std::string normalised(const std::string& word) {
  std::string result = word.substr(0, kLongestWord);
  for (char& c : result) {
    c = c == '-' || c == ' ' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return result;
}

}  // namespace

int editDistance(const std::string& a, const std::string& b) {
  std::vector<int> before(b.size() + 1), last(b.size() + 1), now(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int replace = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, replace});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) now[j] = std::min(now[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(now);
  }
  return last[b.size()];
}

std::string nearestKey(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string wanted = normalised(word);
  std::string best;
  // At most two edits in a short word, or a third of a long one; a farther guess would confuse.
  int best_distance = std::max(2, static_cast<int>(wanted.size()) / 3) + 1;
  for (const std::string& candidate : candidates) {
    const int distance = editDistance(wanted, normalised(candidate));
    const bool shares_something = distance < static_cast<int>(std::max(wanted.size(), candidate.size()));
    if (distance < best_distance && shares_something) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

std::string suggestKey(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string nearest = nearestKey(word, candidates);
  if (!nearest.empty()) return "did you mean '" + nearest + "'?";
  std::string list;
  for (const std::string& candidate : candidates) list += (list.empty() ? "" : ", ") + candidate;
  return "known are " + list;
}

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
