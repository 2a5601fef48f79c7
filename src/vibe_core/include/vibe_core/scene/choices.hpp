#pragma once
#include <string>
#include <vector>

namespace vibe {

/// A word that a key of a scene file accepts.
struct Choice {
  std::string word;
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
