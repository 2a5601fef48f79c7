#pragma once
#include <optional>

#include "vibe_core/geometry/anatomical_map.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/trainee/observation.hpp"

namespace vibe {

/// What the needle would meet if its arm closed now, as seen beside the device.
struct NeedleView {
  double depth = 0;      ///< of the needle below the mucosa; negative: it passes by [m]
  double thickness = 0;  ///< of the wall there, at rest [m]
  WallPoint where;
};

/// Empty if nothing is near.
std::optional<NeedleView> lookAtNeedle(const Model& model, const Observation& seen);

}  // namespace vibe
