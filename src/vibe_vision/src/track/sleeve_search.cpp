#include <algorithm>
#include <cmath>

#include "track/arithmetic.hpp"
#include "track/sleeve_pattern.hpp"

namespace vibe::vision {

namespace {

constexpr double kSearchRim = 0.6;       // of the radius: rows that show nearly the same
constexpr double kMeanCosine = 0.938;    // of the angle around the rod over these rows
constexpr float kSearchVariance = 0.5F;  // of the blur [px^2]
constexpr int kGuesses = 8;

/// Half length of the profile: white ends are left out as far as the motion mixes them with what is behind.
std::ptrdiff_t stepsOf(double half_length, double motion, double scale) {
  return static_cast<std::ptrdiff_t>(std::max(half_length * scale - 1 - motion / 2, 0.3 * half_length));
}

/// Part of u - half to u + half that lies between two places.
float overlap(float u, float half, float begin, float end) {
  return std::clamp(std::min(u + half, end) - std::max(u - half, begin), 0.0F, 2 * half) / (2 * half);
}

constexpr float kTellReach = 2.7F;    // standard deviations from an edge within which a pixel tells something
constexpr float kMaxUneven = 0.15F;   // of the motions of bars and stripe at an end of the helix [px]
constexpr float kLongHalfMotion = 4;  // half of one that leaves few pixels that are not near a corner [px]

}  // namespace

double SleevePattern::searchHalfWidth() const {
  return kSearchRim * radius_;
}

void SleevePattern::searchProfile(double motion, double scale, std::vector<float>& profile) const {
  const std::ptrdiff_t steps = stepsOf(half_length_, motion, scale);
  const auto half = static_cast<float>(std::max(motion, 1.0) / 2 / scale);
  profile.clear();
  for (std::ptrdiff_t k = -steps; k <= steps; ++k) {
    const auto u = static_cast<float>(static_cast<double>(k) / scale);
    const float bars = bars_.at(u + half, kSearchVariance).integral - bars_.at(u - half, kSearchVariance).integral;
    profile.push_back(1 - bars / (2 * half) - stripe_.mean() * overlap(u, half, helix_begin_, helix_end_));
  }
}

/// The first harmonic of the stripe. Its mean over the rows is smaller, and the motion makes it smaller still.
void SleevePattern::searchTurns(double motion, double scale, std::vector<float>& cosine,
                                std::vector<float>& sine) const {
  const std::ptrdiff_t steps = stepsOf(half_length_, motion, scale);
  const double half = std::max(motion, 1.0) / 2 / scale, travel = 2 * M_PI * half / std::abs(pitch_);
  const double size = 2 / M_PI * std::sin(M_PI * stripe_.mean()) * kMeanCosine * std::sin(travel) / travel;
  cosine.clear();
  sine.clear();
  for (std::ptrdiff_t k = -steps; k <= steps; ++k) {
    const double u = static_cast<double>(k) / scale, turn = 2 * M_PI * u / pitch_;
    const double window = size * overlap(static_cast<float>(u), static_cast<float>(half), helix_begin_, helix_end_);
    cosine.push_back(static_cast<float>(-window * std::cos(turn)));
    sine.push_back(static_cast<float>(window * std::sin(turn)));
  }
}

std::vector<double> SleevePattern::rotationGuesses() const {
  std::vector<double> guesses;
  for (int k = 0; k < kGuesses; ++k) guesses.push_back(2 * M_PI * k / kGuesses);
  return guesses;
}

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
