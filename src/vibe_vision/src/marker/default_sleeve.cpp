#include "vibe_vision/marker/marker_design.hpp"

namespace vibe::vision {

/// Bars: of random layouts with at least ten edges, improved edge by edge, the one with the smallest side lobes of the
/// multiple correlation that the search uses, over motion blurs of 0 to 20 px, sizes of 0.75 to 1.1 and all rotations.
/// Stripe: one pitch long, so that every rotation shows as many edges. docs/vision.md, "Markers".
SleeveDesign defaultSleeve() {
  SleeveDesign design;
  design.diameter = 3e-3;
  design.length = 10e-3;
  design.bars = {{-4.05e-3, -3.75e-3}, {-3.35e-3, -2.75e-3}, {2.05e-3, 2.6e-3}, {3.05e-3, 3.45e-3}, {3.75e-3, 4.05e-3}};
  design.helix_begin = -2.2e-3;
  design.helix_end = 1.8e-3;
  design.helix_pitch = 4e-3;
  design.helix_duty = 0.5;
  return design;
}

}  // namespace vibe::vision
