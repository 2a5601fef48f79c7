#pragma once
#include <string>

#include "vibe_core/scene/yaml_source.hpp"

namespace vibe {

/// Parses the text once without building anything. Rejects text that is too large, nested too deeply for a recursive
/// parser, not YAML, or not exactly one document.
/// @throws Error with place:line
void checkYaml(const std::string& text, const std::string& place, const YamlLimits& limits);

}  // namespace vibe
