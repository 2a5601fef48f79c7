#pragma once

#include <string>
#include <vector>

#include "vibe_core/scene/schema.hpp"
#include "vibe_core/scene/yaml_source.hpp"

namespace vibe {

/// Source of a number that no publication gives.
constexpr const char* kChoice = "design choice";

/// Rows of the sections helix, suture, bleeding and marking: what the procedure adds to the organ and the scope.
std::vector<SchemaRow> procedureRows();

/// A key or section of older scene files that has another name now.
struct RenamedKey {
  const char* old_key;  ///< full path, e.g. "suture.pulling"
  const char* new_key;
};

/// All of them; docs/scenes.md shows the same table.
const std::vector<RenamedKey>& renamedKeys();

/// The new name of an old key, or null for any other text.
const char* newNameOf(const std::string& key);

/// Reads the value of one key into the scene, checking type, unit and range against its row.
/// @param scene  with the row's section present
/// @throws Error
void readValue(const YamlSource& source, const YamlField& field, const SchemaRow& row, Scene& scene);

/// The value as YAML in plain SI numbers, read back to the same bits by readValue(). Empty for an absent point.
std::string valueText(const SchemaRow& row, Scene& scene);

/// Whether the scene holds something else than the "absent" value of the row's struct member.
bool isGiven(const SchemaRow& row, Scene& scene);

}  // namespace vibe
