#pragma once
#include <vector>

#include "vibe_core/scene/schema.hpp"

namespace vibe {

/// Source of a number that no publication gives.
constexpr const char* kChoice = "design choice";

/// Rows of the sections helix, suture, bleeding and marking: what the procedure adds to the organ and the scope.
std::vector<SchemaRow> procedureRows();

}  // namespace vibe
