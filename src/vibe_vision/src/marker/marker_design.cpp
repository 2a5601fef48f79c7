#include "vibe_vision/marker/marker_design.hpp"

#include <cmath>

namespace vibe::vision {

double reflectance(const RingDesign& design, double x, double y) {
  const double diameter = 2 * std::hypot(x, y);
  return diameter < design.outer_diameter && diameter >= design.inner_diameter ? 0 : 1;
}

double reflectance(const SleeveDesign& design, double u, double phi) {
  for (const Bar& bar : design.bars)
    if (u >= bar.begin && u < bar.end) return 0;
  if (u < design.helix_begin || u >= design.helix_end) return 1;
  const double phase = u / design.helix_pitch - phi / (2 * M_PI) + design.helix_duty / 2;
  return phase - std::floor(phase) < design.helix_duty ? 0 : 1;
}

}  // namespace vibe::vision
