#include "vibe_vision/track/marker_pattern.hpp"

#include "track/ring_pattern.hpp"
#include "track/sleeve_pattern.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::vision {

void PixelBlock::allocate(std::size_t capacity) {
  const std::size_t size = (capacity + kLanes - 1) / kLanes * kLanes;
  along.assign(size, 0);
  lateral.assign(size, 0);
  value.assign(size, 0);
  weight.assign(size, 0);
  light.assign(size, 1);
  sheen.assign(size, 0);
  count = 0;
}

void PixelBlock::pad() {
  for (std::size_t i = count; i < padded(); ++i) {
    along[i] = along[count - 1];
    lateral[i] = lateral[count - 1];
    value[i] = weight[i] = 0;
  }
}

void PatternValues::allocate(std::size_t capacity, const std::array<bool, kPoseParameters>& observed) {
  const std::size_t size = (capacity + kLanes - 1) / kLanes * kLanes;
  value.assign(size, 0);
  for (std::size_t k = 0; k < observed.size(); ++k) derivative[k].assign(observed[k] ? size : 0, 0);
}

MarkerView markerView(const CameraModel& camera, const SlideAxis& axis) {
  const Eigen::Vector2d offset = Eigen::Vector2d(camera.cx, camera.cy) - axis.origin;
  return {camera.fx, offset.dot(axis.direction), offset.dot(acrossOf(axis))};
}

void MarkerPattern::select(const MarkerPose&, double, PixelBlock&) const {}

std::unique_ptr<MarkerPattern> makePattern(const MarkerDesign& design, double pixels_per_metre,
                                           const MarkerView& view) {
  if (const auto* ring = std::get_if<RingDesign>(&design))
    return std::make_unique<RingPattern>(*ring, pixels_per_metre);
  if (std::holds_alternative<TagDesign>(design))
    throw Error("a tag of another library has no pattern to fit; track it with a Tracker");
  return std::make_unique<SleevePattern>(std::get<SleeveDesign>(design), pixels_per_metre, view);
}

}  // namespace vibe::vision
