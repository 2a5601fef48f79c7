#pragma once

#include <array>
#include <optional>

#include "vibe_core/geometry/organ.hpp"

namespace vibe {

/// Shares of the area of the inside of the wall at rest that the endoscope has seen, from 0 to 1. Empty: the organ has
/// nothing of it.
struct CoverageSkill {
  std::optional<double> whole;                             ///< without the ends
  std::array<std::optional<double>, kRegionCount> region;  ///< in the order of Region
  std::array<std::optional<double>, kWallCount> wall;      ///< in the order of Wall
};

}  // namespace vibe
