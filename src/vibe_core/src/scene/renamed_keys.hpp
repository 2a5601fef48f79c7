#pragma once
#include <string>
#include <vector>

namespace vibe {

/// A key or section of older scene files that has another name now.
struct RenamedKey {
  const char* old_key;  ///< full path, e.g. "suture.pulling"
  const char* new_key;
};

/// All of them; docs/scenes.md shows the same table.
const std::vector<RenamedKey>& renamedKeys();

/// The new name of an old key, or null for any other text.
const char* newNameOf(const std::string& key);

}  // namespace vibe
