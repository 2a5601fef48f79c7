#pragma once

#include <string>
#include <vector>

namespace vibe {

/// Number of inserted, deleted, replaced and swapped neighbouring characters between two words
/// (optimal string alignment distance: Damerau 1964, Levenshtein 1966).
int editDistance(const std::string& a, const std::string& b);

/// The candidate that a user most likely meant by `word`, or empty if none is near. Upper and lower case, '-' and '_'
/// count as equal; the first of equally near candidates is returned.
std::string nearestKey(const std::string& word, const std::vector<std::string>& candidates);

/// Remedy for an unknown word: "did you mean 'x'?" or, without a near candidate, "known are a, b, c".
std::string suggestKey(const std::string& word, const std::vector<std::string>& candidates);

/// A word that a key of a scene file accepts.
struct Choice {
  std::string word;          ///< as it stands in a scene file
  std::string meaning;       ///< one line, shown in the documentation
  std::string package = "";  ///< that must be loaded for it; empty: the library itself, or loaded already
};

/// The words of a key whose list is open to other packages (tissue.law, tissue.model, suture.cinch_model,
/// marking.deformation): those of the library in the order of their list, then the registered ones. Empty for every
/// other key.
std::vector<Choice> choicesOf(const std::string& key);

/// Words of a key that come with a package beside this one that the program has not loaded.
std::vector<Choice> choicesNotLoaded(const std::string& key);

/// One of them named where it cannot be used: what is missing and the remedy, as the end of a sentence.
std::string sayNotLoaded(const Choice& choice);

/// @throws Error unless the word is in choicesOf(key): how to load it, or which word is nearest
void checkChoice(const std::string& key, const std::string& word);

/// Adds a word to such a key. Scenes that are read from now on may use it. Called by registerMaterialLaw(),
/// registerTissueModel(), registerCinchModel() and registerMarkingDeformation(); safe to call from any thread.
/// @throws Error if the key has no open list, the word is already in it, or it is not made of a-z, 0-9 and '_'
void addChoice(const std::string& key, const Choice& choice);

}  // namespace vibe
