#pragma once
#include <string>
#include <vector>

namespace vibe {

/// A word that a key of a scene file accepts.
struct Choice {
  std::string word;
  std::string meaning;  ///< one line, shown in the documentation
};

/// The words of a key whose list is open to other packages (tissue.law, tissue.model): those of the library in the
/// order of their list, then the registered ones. Empty for every other key.
std::vector<Choice> choicesOf(const std::string& key);

/// Adds a word to such a key. Scenes that are read from now on may use it. Called by registerMaterialLaw() and
/// registerTissueModel(); safe to call from any thread.
/// @throws Error if the key has no open list, the word is already in it, or it is not made of a-z, 0-9 and '_'
void addChoice(const std::string& key, const Choice& choice);

}  // namespace vibe
