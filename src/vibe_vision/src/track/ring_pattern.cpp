#include "track/ring_pattern.hpp"

#include <algorithm>
#include <cmath>

namespace vibe {
namespace {

constexpr double kPixelVariance = 1.0 / 12;  // of the area of a pixel [px^2]
constexpr double kMaxMotion = 48;            // during the exposure [px]
constexpr double kTail = 3;                  // standard deviations of the blur that an edge reaches
constexpr double kMaxScale = 1.3;            // of the marker's size
constexpr std::size_t kPart = 64;            // pixels at a time: all of it stays in the first cache

using Four [[gnu::vector_size(16)]] = float;

Four load(const float* p) {
  Four v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}

float sum(Four v) {
  return (v[0] + v[1]) + (v[2] + v[3]);
}

/// Weights of the cubic B-spline and their derivatives at a fraction f.
struct Spline {
  Four weight, first, second;
  explicit Spline(float f) {
    const Four c0{1.F / 6, 2.F / 3, 1.F / 6, 0}, c1{-0.5F, 0, 0.5F, 0}, c2{0.5F, -1, 0.5F, 0},
        c3{-1.F / 6, 0.5F, -0.5F, 1.F / 6};
    weight = c0 + f * (c1 + f * (c2 + f * c3));
    first = c1 + f * (2 * c2 + (3 * f) * c3);
    second = 2 * c2 + (6 * f) * c3;
  }
};

double tableBlur(const MarkerPose& pose) {
  return std::sqrt(pose.blur * pose.blur + kPixelVariance) * std::exp(-pose.log_scale - pose.log_aspect / 2);
}

double reach(double outer, double half_side) {
  return std::min(half_side, outer + kTail * RingTable::kMaxBlur);
}

}  // namespace

/// All in the table's pixels, relative to the marker's centre; x, y: in the image's.
struct RingPattern::Part {
  alignas(16) float x[kPart], y[kPart];
  alignas(16) float row[kPart], column[kPart];  // in steps of the table, not below 0
  alignas(16) float sign_u[kPart], sign_v[kPart];
  alignas(16) float u[kPart], v[kPart];
  alignas(16) float value[kPart], by_u[kPart], by_v[kPart], laplacian[kPart];
};

RingPattern::RingPattern(const RingDesign& design, double pixels_per_metre)
    : inner_(design.inner_diameter / 2 * pixels_per_metre),
      outer_(design.outer_diameter / 2 * pixels_per_metre),
      half_side_(design.side / 2 * pixels_per_metre),
      table_(inner_, outer_, std::min(half_side_, reach(outer_, half_side_) + kMaxMotion / 2),
             reach(outer_, half_side_), kMaxMotion) {}

std::array<bool, kPoseParameters> RingPattern::observes() const {
  std::array<bool, kPoseParameters> shown{};
  for (int k : {kAlong, kLateral, kLogScale, kLogAspect, kBlur, kKeystone}) shown[k] = true;
  return shown;
}

Eigen::Vector2d RingPattern::window(const MarkerPose& pose, double motion) const {
  const double blur = std::sqrt(pose.blur * pose.blur + kPixelVariance) * kTail;
  const double size_v = std::exp(pose.log_scale), size_u = size_v * std::exp(pose.log_aspect);
  const double travel = std::min(std::abs(motion), kMaxMotion) / 2;
  const double u = std::min(outer_ * size_u + blur + travel, half_side_ * size_u - blur - travel);
  const double v = std::min(outer_ * size_v + blur, half_side_ * size_v - blur);
  return {std::max(u, inner_ * size_u), std::max(v, inner_ * size_v)};
}

Eigen::Vector2d RingPattern::maxWindow() const {
  return Eigen::Vector2d::Constant(half_side_ * kMaxScale);
}

void RingPattern::prepare(const MarkerPose& pose, double motion) {
  table_.compose(tableBlur(pose), motion * std::exp(-pose.log_scale - pose.log_aspect));
}

void RingPattern::evaluate(const MarkerPose& pose, const PixelBlock& pixels, PatternValues& values) {
  Part part;
  for (std::size_t begin = 0; begin < pixels.padded(); begin += kPart) {
    place(pose, pixels, begin, part);
    readTable(part);
    chain(pose, begin, part, values);
  }
}

void RingPattern::place(const MarkerPose& pose, const PixelBlock& pixels, std::size_t begin, Part& part) const {
  const std::size_t count = std::min(kPart, pixels.padded() - begin);
  const auto along = static_cast<float>(pose.along), lateral = static_cast<float>(pose.lateral);
  const auto keystone = static_cast<float>(pose.keystone);
  const auto inverse_u = static_cast<float>(std::exp(-pose.log_scale - pose.log_aspect));
  const auto inverse_v = static_cast<float>(std::exp(-pose.log_scale));
  constexpr auto kPerPixel = static_cast<float>(1 / RingTable::kStep);
  const auto last_row = static_cast<float>(table_.rows() - 3) - 0.01F;
  const auto last_column = static_cast<float>(table_.columns() - 3) - 0.01F;
  for (std::size_t i = 0; i < count; ++i) {
    const float x = pixels.along[begin + i] - along, y = pixels.lateral[begin + i] - lateral;
    const float shrink = 1 - keystone * x;
    const float u = x * shrink * inverse_u, v = y * shrink * inverse_v;
    part.x[i] = x, part.y[i] = y, part.u[i] = u, part.v[i] = v;
    part.sign_u[i] = std::copysign(kPerPixel, u), part.sign_v[i] = std::copysign(kPerPixel, v);
    part.row[i] = std::min(std::abs(u) * kPerPixel + RingTable::kMargin, last_row);
    part.column[i] = std::min(std::abs(v) * kPerPixel + RingTable::kMargin, last_column);
  }
  for (std::size_t i = count; i < kPart; ++i) part.row[i] = part.column[i] = RingTable::kMargin;
}

void RingPattern::readTable(Part& part) const {
  for (std::size_t i = 0; i < kPart; ++i) {
    const int r = static_cast<int>(part.row[i]), c = static_cast<int>(part.column[i]);
    const Spline u(part.row[i] - static_cast<float>(r)), v(part.column[i] - static_cast<float>(c));
    const float* p = table_.row(r - 1) + (c - 1);
    const Four a = load(p), b = load(p + table_.columns()), d = load(p + 2 * table_.columns()),
               e = load(p + 3 * table_.columns());
    const Four mean = u.weight[0] * a + u.weight[1] * b + u.weight[2] * d + u.weight[3] * e;
    const Four slope = u.first[0] * a + u.first[1] * b + u.first[2] * d + u.first[3] * e;
    const Four bend = u.second[0] * a + u.second[1] * b + u.second[2] * d + u.second[3] * e;
    part.value[i] = sum(mean * v.weight);
    part.by_u[i] = sum(slope * v.weight);
    part.by_v[i] = sum(mean * v.first);
    part.laplacian[i] = sum(bend * v.weight + mean * v.second);
  }
}

/// From the table's derivatives to those by the pose. A change of the variance of the blur adds half the Laplacian.
void RingPattern::chain(const MarkerPose& pose, std::size_t begin, const Part& part, PatternValues& values) const {
  const std::size_t count = std::min(kPart, values.value.size() - begin);
  const auto keystone = static_cast<float>(pose.keystone);
  const auto inverse_u = static_cast<float>(std::exp(-pose.log_scale - pose.log_aspect));
  const auto inverse_v = static_cast<float>(std::exp(-pose.log_scale));
  const double blur = tableBlur(pose);
  const auto spread = static_cast<float>((blur * blur - table_.blur() * table_.blur()) / 2);
  const auto by_blur = static_cast<float>(pose.blur) * inverse_u * inverse_v,
             variance = static_cast<float>(blur * blur);
  constexpr auto kPerArea = static_cast<float>(1 / (RingTable::kStep * RingTable::kStep));
  std::array<float*, kPoseParameters> out;
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k] = values.derivative[k].empty() ? nullptr : values.derivative[k].data() + begin;
  for (std::size_t i = 0; i < count; ++i) {
    const float x = part.x[i], y = part.y[i], laplacian = kPerArea * part.laplacian[i];
    const float by_u = part.sign_u[i] * part.by_u[i], by_v = part.sign_v[i] * part.by_v[i];
    const float along_u = part.u[i] * by_u, along_v = part.v[i] * by_v;
    values.value[begin + i] = part.value[i] + spread * laplacian;
    out[kAlong][i] = -(1 - 2 * keystone * x) * inverse_u * by_u + keystone * y * inverse_v * by_v;
    out[kLateral][i] = -(1 - keystone * x) * inverse_v * by_v;
    out[kLogScale][i] = -along_u - along_v - variance * laplacian;
    out[kLogAspect][i] = -along_u - 0.5F * variance * laplacian;
    out[kBlur][i] = by_blur * laplacian;
    out[kKeystone][i] = -x * (x * inverse_u * by_u + y * inverse_v * by_v);
  }
}

double RingPattern::searchHalfWidth() const {
  return 0.5 * outer_;
}

/// Chords of the two discs at the middle of the band; the blur of the optics does not matter here.
void RingPattern::searchProfile(double motion, double scale, std::vector<float>& profile) const {
  const double inner = inner_ * scale, outer = outer_ * scale;
  const auto half = static_cast<int>(std::ceil(std::min(half_side_ * scale - 2, outer + 4)));
  constexpr int kRows = 8, kShifts = 9;
  const double travel = std::min(std::abs(motion), half_side_ / 2);
  profile.assign(static_cast<std::size_t>(2 * half + 1), 0);
  for (int i = -half; i <= half; ++i) {
    double white = 0;
    for (int row = 0; row < kRows; ++row) {
      const double v = (row + 0.5) / kRows * searchHalfWidth();
      for (int k = 0; k < kShifts; ++k) {
        const double u = i + (travel + 1) * ((k + 0.5) / kShifts - 0.5), r = std::hypot(u, v);
        white += r < inner || r > outer ? 1 : 0;
      }
    }
    profile[static_cast<std::size_t>(i + half)] = static_cast<float>(white / (kRows * kShifts));
  }
}

}  // namespace vibe
