#pragma once
#include <string>

#include "vibe_core/scene/schema.hpp"
#include "vibe_core/scene/yaml_source.hpp"

namespace vibe {

/// Reads the value of one key into the scene, checking type, unit and range against its row.
/// @param scene  with the row's section present
/// @throws Error
void readValue(const YamlSource& source, const YamlField& field, const SchemaRow& row, Scene& scene);

/// The value as YAML in plain SI numbers, read back to the same bits by readValue(). Empty for an absent point.
std::string valueText(const SchemaRow& row, Scene& scene);

/// Whether the scene holds something else than the "absent" value of the row's struct member.
bool isGiven(const SchemaRow& row, Scene& scene);

}  // namespace vibe
