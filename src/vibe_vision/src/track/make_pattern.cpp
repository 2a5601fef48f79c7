#include "track/ring_pattern.hpp"
#include "track/sleeve_pattern.hpp"
#include "vibe_vision/track/marker_pattern.hpp"

namespace vibe::vision {

std::unique_ptr<MarkerPattern> makePattern(const MarkerDesign& design, double pixels_per_metre,
                                           const MarkerView& view) {
  if (const auto* ring = std::get_if<RingDesign>(&design))
    return std::make_unique<RingPattern>(*ring, pixels_per_metre);
  return std::make_unique<SleevePattern>(std::get<SleeveDesign>(design), pixels_per_metre, view);
}

}  // namespace vibe::vision
