#include "track/cut_stripe.hpp"

#include <array>
#include <cmath>

namespace vibe::vision {

NormalTable::NormalTable() {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const double x = static_cast<double>(i) / kPerUnit - kReach;
    const double value = 0.5 * std::erfc(-x * M_SQRT1_2), density = std::exp(-x * x / 2) / std::sqrt(2 * M_PI);
    entries_[i] = {static_cast<float>(x * value + density), static_cast<float>(value), static_cast<float>(density)};
  }
}

const NormalTable& NormalTable::instance() {
  static const NormalTable table;
  return table;
}

namespace {

// Midpoint rule over the blur across the axis, in standard deviations: the integrand has kinks.
constexpr std::size_t kNodes = 9;
constexpr float kSpacing = 0.62F;
constexpr float kSpread = kSpacing * (kNodes / 2);
struct Node {
  float place, weight;
};

std::array<Node, kNodes> makeNodes() {
  std::array<Node, kNodes> nodes{};
  double sum = 0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    nodes[i].place = (static_cast<float>(i) - (kNodes - 1) / 2) * kSpacing;
    nodes[i].weight = std::exp(-nodes[i].place * nodes[i].place / 2);
    sum += nodes[i].weight;
  }
  for (Node& node : nodes) node.weight /= static_cast<float>(sum);
  return nodes;
}

}  // namespace

CutStripe::CutStripe(double period, double black, const BlurredLine& line)
    : line_(line),
      period_(static_cast<float>(period)),
      inverse_period_(1 / period_),
      half_black_(static_cast<float>(black / 2)),
      mean_(static_cast<float>(black / period)) {}

/// Of a cut at this phase, within half a period of a black part's centre, the last edge of the stripe before it.
float CutStripe::edgeBefore(float phase, bool black) const {
  if (black) return -half_black_ - phase;
  return (phase < 0 ? half_black_ - period_ : half_black_) - phase;
}

CutStripe::Entry CutStripe::at(float y, float phase, float variance, float cut_variance, float full_variance) const {
  const float deviation = std::sqrt(variance), reach = kEdgeReach * deviation;
  if (edgeDistance(phase) > kCornerReach * std::sqrt(full_variance))
    return farFromEdges(y, phase, deviation, full_variance);
  if (y < -reach) {
    const BlurredLine::Entry e = line_.at(phase + y, full_variance);
    return {e.integral + mean_ * y, e.value, e.slope, e.value - mean_};
  }
  const BlurredLine::Entry whole = line_.at(phase, cut_variance);  // up to the cut
  Entry result{whole.integral, 0, 0, whole.value - mean_};
  if (y > reach) return result;
  const Entry rest = nearCut(y, phase, deviation, std::sqrt(cut_variance));
  result.integral -= rest.integral;
  result.value = rest.value;
  result.slope = rest.slope;
  result.by_shift -= rest.by_shift;
  return result;
}

/// The stripe as if it went on, and a blurred step at the cut if it is black there.
CutStripe::Entry CutStripe::farFromEdges(float y, float phase, float deviation, float full_variance) const {
  const float before = y < 0 ? y : 0.0F, sign = y < 0 ? -1.0F : 1.0F;
  const float black = std::abs(wrapped(phase)) < half_black_ ? 1.0F : 0.0F;
  const BlurredLine::Entry whole = line_.at(phase + before, full_variance);
  const NormalTable::Entry step = NormalTable::instance().at(-sign * y / deviation);
  const float seen = y < 0 ? 1.0F : 0.0F;
  return {whole.integral + mean_ * before - black * deviation * step.integral,
          seen * whole.value + sign * black * step.value, seen * whole.slope - black * step.density / deviation,
          whole.value - mean_};
}

/// What the blur along the axis takes away from the integral up to the cut. With B black at the cut and an edge of the
/// stripe at z < 0, that is B I(-y) + (1 - 2 B) I(z - y), where I is the integral of a blurred step.
CutStripe::Entry CutStripe::nearCut(float y, float phase, float deviation, float cut_deviation) const {
  static const std::array<Node, kNodes> nodes = makeNodes();
  const NormalTable& normal = NormalTable::instance();
  const float inverse = 1 / deviation;
  const NormalTable::Entry cut = normal.at(-y * inverse);
  const float place = wrapped(phase);
  const float spread = kSpread * cut_deviation;
  const bool is_black = std::abs(place) < half_black_;
  const float last = edgeBefore(place, is_black);
  if (last + spread < y - kEdgeReach * deviation && edgeDistance(phase) > spread) {
    if (!is_black) return {0, 0, 0, 0};
    return {deviation * cut.integral, cut.value, -inverse * cut.density, 0};
  }
  Entry sum{};
  for (const Node& node : nodes) {
    float p = place + node.place * cut_deviation;
    if (p > period_ / 2) p -= period_;
    if (p < -period_ / 2) p += period_;
    const bool black = std::abs(p) < half_black_;
    const float z = edgeBefore(p, black);
    const NormalTable::Entry edge = normal.at((z - y) * inverse);
    const float b = black ? 1.0F : 0.0F, c = node.weight * (1 - 2 * b);
    sum.integral += deviation * (node.weight * b * cut.integral + c * edge.integral);
    sum.value += node.weight * b * cut.value + c * edge.value;
    sum.slope -= inverse * (node.weight * b * cut.density + c * edge.density);
    sum.by_shift -= c * edge.value;
  }
  return sum;
}

}  // namespace vibe::vision
