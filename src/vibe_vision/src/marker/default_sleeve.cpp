#include "vibe_vision/marker/marker_design.hpp"

namespace vibe {

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

}  // namespace vibe
