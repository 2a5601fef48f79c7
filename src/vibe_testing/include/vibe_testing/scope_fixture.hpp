#pragma once

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "vibe_core/tool/tool_model.hpp"

namespace vibe {

/// Of the endoscope's URDF. VIBE_DESCRIPTION_DIR is the folder of vibe_description; who includes this defines it.
inline std::string scopePath() {
  return std::string(VIBE_DESCRIPTION_DIR) + "/urdf/scope.urdf";
}

/// The text of the endoscope's URDF.
inline std::string scopeText() {
  std::ifstream file(scopePath());
  std::ostringstream text;
  text << file.rdbuf();
  if (text.str().empty()) throw std::runtime_error("cannot read " + scopePath());
  return text.str();
}

/// The tool of that URDF.
inline ToolModel loadScope() {
  return ToolModel::fromUrdf(scopeText(), "scope.urdf");
}

}  // namespace vibe
