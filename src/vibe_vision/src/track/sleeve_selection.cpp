#include <cmath>

#include "track/lanes.hpp"
#include "track/sleeve_part.hpp"

namespace vibe::vision {
namespace {

constexpr float kTellReach = 2.7F;    // standard deviations from an edge within which a pixel tells something
constexpr float kMaxUneven = 0.15F;   // of the motions of bars and stripe at an end of the helix [px]
constexpr float kLongHalfMotion = 4;  // half of one that leaves few pixels that are not near a corner [px]

}  // namespace

/// Pixels of the sleeve near an edge. Those where the helix ends at an edge of the stripe are few and costly.
void SleevePattern::select(const MarkerPose& pose, double motion, PixelBlock& pixels) const {
  const View view = viewOf(pose, std::min(std::abs(motion), 2.0 * MovingLine::kMaxHalfMotion));
  const Eigen::Vector2f half = (printWindow(pose, motion) * view.inverse_scale).cast<float>();
  Part part;
  std::size_t n = 0;
  for (std::size_t begin = 0; begin < pixels.count; begin += Part::kSize) {
    part.size = std::min(Part::kSize, pixels.count - begin);
    placePixels(view, pixels, begin, part);
    mark(part);
    for (std::size_t i = 0; i < part.size; ++i) {
      pixels.along[n] = pixels.along[begin + i], pixels.lateral[n] = pixels.lateral[begin + i];
      pixels.value[n] = pixels.value[begin + i], pixels.weight[n] = pixels.weight[begin + i];
      n += std::abs(part.x[i]) <= half.x() && std::abs(part.v[i]) <= half.y() ? static_cast<std::size_t>(part.tells[i])
                                                                              : 0;
    }
  }
  pixels.count = n;
  pixels.pad();
}

VIBE_LANES void SleevePattern::mark(Part& __restrict part) const {
  const float last = static_cast<float>(edge_distance_.size() - 1), first = static_cast<float>(half_length_) + 0.5F;
  const float begin = helix_begin_, end = helix_end_;
  const CutStripe stripe_edges = cut_;
  alignas(64) int place[Part::kSize];
  alignas(64) float edge[Part::kSize];
  for (std::size_t i = 0; i < Part::kSize; ++i) {
    float at = part.u[i] + first;
    at = at < 0 ? 0 : at;
    place[i] = static_cast<int>(at > last ? last : at);
  }
  for (std::size_t i = 0; i < Part::kSize; ++i) edge[i] = edge_distance_[static_cast<std::size_t>(place[i])];
  for (std::size_t i = 0; i < Part::kSize; ++i) {
    const float u = part.u[i], w = part.w[i], deviation = std::sqrt(part.stripe_variance[i]);
    const float half = part.half_motion[i], stripe_half = part.stripe_half_motion[i];
    const float phase = w - u + (std::abs(u - begin) < std::abs(u - end) ? begin : end);
    const int bar = edge[i] < kTellReach * std::sqrt(part.bar_variance[i]) + half + 0.5F ? 1 : 0;
    const int stripe = stripe_edges.edgeDistance(w) < kTellReach * deviation + stripe_half ? 1 : 0;
    const int corner = stripe_edges.edgeDistance(phase) < kCornerReach * deviation ? 1 : 0;
    const int black = stripe_edges.isBlack(phase) ? 1 : 0, is_long = half > kLongHalfMotion ? 1 : 0;
    const int even = std::abs(stripe_half - half) < kMaxUneven ? 1 : 0;  // on a tilted rod; not exact here
    const int inside = part.inside[i] > 0 ? 1 : 0, outside = part.outside[i] > 0 ? 1 : 0;
    const int mixed = (corner & bar & is_long) | ((1 - corner) & even & (bar | stripe | black));
    part.tells[i] = (outside & bar) | (inside & stripe) | ((1 - outside) & (1 - inside) & mixed);
  }
}

}  // namespace vibe::vision
