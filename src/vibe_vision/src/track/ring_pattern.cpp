#include "track/ring_pattern.hpp"

#include <algorithm>
#include <cmath>

#include "track/arithmetic.hpp"

namespace vibe::vision {
namespace {

constexpr double kMaxMotion = 48;  // during the exposure [px]
constexpr double kBlurTail = 3;    // standard deviations of the blur that an edge reaches

/// Four values of one pixel and four of the next.
using TwoFours [[gnu::vector_size(32)]] = float;
using Places [[gnu::vector_size(32)]] = int;

/// Weights of the cubic B-spline and their derivatives at a fraction f of one pixel, g of the next.
struct Spline {
  TwoFours weight, first, second;
  [[gnu::always_inline]] Spline(float f, float g) {
    const TwoFours c0{1.F / 6, 2.F / 3, 1.F / 6, 0, 1.F / 6, 2.F / 3, 1.F / 6, 0};
    const TwoFours c1{-0.5F, 0, 0.5F, 0, -0.5F, 0, 0.5F, 0}, c2{0.5F, -1, 0.5F, 0, 0.5F, -1, 0.5F, 0};
    const TwoFours c3{-1.F / 6, 0.5F, -0.5F, 1.F / 6, -1.F / 6, 0.5F, -0.5F, 1.F / 6}, h{f, f, f, f, g, g, g, g};
    weight = c0 + h * (c1 + h * (c2 + h * c3));
    first = c1 + h * (2 * c2 + (3 * h) * c3);
    second = 2 * c2 + (6 * h) * c3;
  }
};

double tableBlur(const MarkerPose& pose) {
  return std::sqrt(pose.blur * pose.blur + kPixelVariance) * std::exp(-pose.log_scale - pose.log_aspect / 2);
}

/// From the image to the table: turned to the marker, stretched to its true shape, then turned so that the motion is
/// along u. A ring looks the same from all sides.
struct TableFrame {
  double cos_tilt, sin_tilt, inverse_u, inverse_v;  ///< marker
  double cos_motion, sin_motion;                    ///< direction of the motion on the marker
  double motion;                                    ///< on the marker, per pixel in the image

  explicit TableFrame(const MarkerPose& pose)
      : cos_tilt(std::cos(pose.tilt)),
        sin_tilt(std::sin(pose.tilt)),
        inverse_u(std::exp(-pose.log_scale - pose.log_aspect)),
        inverse_v(std::exp(-pose.log_scale)) {
    const double u = cos_tilt * inverse_u, v = -sin_tilt * inverse_v;
    motion = std::hypot(u, v);
    cos_motion = u / motion, sin_motion = v / motion;
  }
};

/// Two bands around circles, squares of their radii on the marker; before the motion, and after it.
struct Edges {
  float along, lateral, inverse_u, inverse_v, travel;
  float inner_begin, inner_end, outer_begin, outer_end;
};

/// @param tells  1: the pixel is in a band at some time, else 0
VIBE_LANES void mark(const Edges& all, const float* __restrict along, const float* __restrict lateral,
                     std::size_t count, int* __restrict tells) {
  const Edges e = all;
  for (std::size_t i = 0; i < count; ++i) {
    const float u = std::abs(along[i] - e.along) * e.inverse_u, v = (lateral[i] - e.lateral) * e.inverse_v;
    const float near_u = u > e.travel ? u - e.travel : 0, far_u = u + e.travel;
    const float nearest = near_u * near_u + v * v, farthest = far_u * far_u + v * v;
    const int at_inner = (nearest < e.inner_end ? 1 : 0) & (farthest > e.inner_begin ? 1 : 0);
    const int at_outer = (nearest < e.outer_end ? 1 : 0) & (farthest > e.outer_begin ? 1 : 0);
    tells[i] = at_inner | at_outer;
  }
}

double reach(double outer, double half_side) {
  return std::min(half_side, outer + kBlurTail * RingTable::kMaxBlur);
}

}  // namespace

/// All in the table's pixels, relative to the marker's centre; x, y: in the image's.
struct RingPattern::Part {
  static constexpr std::size_t kSize = 64;  ///< all of it stays in the first cache
  alignas(16) float x[kSize], y[kSize];
  alignas(16) float row[kSize], column[kSize];  // in steps of the table, not below 0
  alignas(16) float sign_u[kSize], sign_v[kSize];
  alignas(16) float u[kSize], v[kSize];
  alignas(16) float value[kSize], by_u[kSize], by_v[kSize], laplacian[kSize];
  std::size_t count;  ///< of pixels, a multiple of kLanes
};

RingPattern::RingPattern(const RingDesign& design, double pixels_per_metre)
    : inner_(design.inner_diameter / 2 * pixels_per_metre),
      outer_(design.outer_diameter / 2 * pixels_per_metre),
      half_side_(design.side / 2 * pixels_per_metre),
      table_(inner_, outer_, std::min(half_side_, reach(outer_, half_side_) + kMaxMotion / 2),
             reach(outer_, half_side_), kMaxMotion) {}

std::array<bool, kPoseParameters> RingPattern::observes() const {
  std::array<bool, kPoseParameters> shown{};
  for (int k : {kAlong, kLateral, kLogScale, kTilt, kLogAspect, kBlur, kKeystone}) shown[k] = true;
  return shown;
}

Eigen::Vector2d RingPattern::window(const MarkerPose& pose, double motion) const {
  const double blur = std::sqrt(pose.blur * pose.blur + kPixelVariance) * kBlurTail;
  const double size_v = std::exp(pose.log_scale), size_u = size_v * std::exp(pose.log_aspect);
  const double travel = std::min(std::abs(motion), kMaxMotion) / 2;
  const double u = std::min(outer_ * size_u + blur + travel, half_side_ * size_u - blur - travel);
  const double v = std::min(outer_ * size_v + blur, half_side_ * size_v - blur);
  return {std::max(u, inner_ * size_u), std::max(v, inner_ * size_v)};
}

/// Keeps what lies near one of the two edges at some time during the exposure.
void RingPattern::select(const MarkerPose& pose, double motion, PixelBlock& pixels) const {
  const double size_v = std::exp(pose.log_scale), size_u = size_v * std::exp(pose.log_aspect);
  const double width = kBlurTail * std::sqrt(pose.blur * pose.blur + kPixelVariance) / size_v;
  const auto square = [](double x) { return static_cast<float>(x * std::abs(x)); };
  const Edges edges{static_cast<float>(pose.along),
                    static_cast<float>(pose.lateral),
                    static_cast<float>(1 / size_u),
                    static_cast<float>(1 / size_v),
                    static_cast<float>(std::min(std::abs(motion), kMaxMotion) / 2 / size_u),
                    square(inner_ - width),
                    square(inner_ + width),
                    square(outer_ - width),
                    square(outer_ + width)};
  int tells[Part::kSize];
  std::size_t n = 0;
  for (std::size_t begin = 0; begin < pixels.count; begin += Part::kSize) {
    const std::size_t count = std::min(Part::kSize, pixels.count - begin);
    mark(edges, pixels.along.data() + begin, pixels.lateral.data() + begin, count, tells);
    for (std::size_t i = 0; i < count; ++i) {
      pixels.along[n] = pixels.along[begin + i], pixels.lateral[n] = pixels.lateral[begin + i];
      pixels.value[n] = pixels.value[begin + i], pixels.weight[n] = pixels.weight[begin + i];
      n += static_cast<std::size_t>(tells[i]);
    }
  }
  pixels.count = n;
  pixels.pad();
}

void RingPattern::prepare(const MarkerPose& pose, const MarkerMotion& motion, bool /*rough*/) {
  table_.compose(tableBlur(pose), motion.length * TableFrame(pose).motion);
}

void RingPattern::evaluate(const MarkerPose& pose, const PixelBlock& pixels, PatternValues& values) {
  Part part;
  for (std::size_t begin = 0; begin < pixels.padded(); begin += Part::kSize) {
    place(pose, pixels, begin, part);
    readTable(part);
    chain(pose, begin, part, values);
  }
}

VIBE_LANES void RingPattern::place(const MarkerPose& pose, const PixelBlock& pixels, std::size_t begin,
                                   Part& part) const {
  const std::size_t count = part.count = std::min(Part::kSize, pixels.padded() - begin);
  const TableFrame frame(pose);
  const auto along = static_cast<float>(pose.along), lateral = static_cast<float>(pose.lateral);
  const auto keystone = static_cast<float>(pose.keystone);
  const auto ct = static_cast<float>(frame.cos_tilt), st = static_cast<float>(frame.sin_tilt);
  const auto cm = static_cast<float>(frame.cos_motion), sm = static_cast<float>(frame.sin_motion);
  const auto inverse_u = static_cast<float>(frame.inverse_u), inverse_v = static_cast<float>(frame.inverse_v);
  constexpr auto kPerPixel = static_cast<float>(1 / RingTable::kStep);
  const auto last_row = static_cast<float>(table_.rows() - 3) - 0.01F;
  const auto last_column = static_cast<float>(table_.columns() - 3) - 0.01F;
  const float *px = pixels.along.data() + begin, *py = pixels.lateral.data() + begin;
  for (std::size_t i = 0; i < count; ++i) {
    const float a = px[i] - along, b = py[i] - lateral;
    const float x = ct * a + st * b, y = ct * b - st * a;
    const float shrink = 1 - keystone * x;
    const float p = x * shrink * inverse_u, q = y * shrink * inverse_v;
    const float u = cm * p + sm * q, v = cm * q - sm * p;
    part.x[i] = x, part.y[i] = y, part.u[i] = u, part.v[i] = v;
    part.sign_u[i] = std::copysign(kPerPixel, u), part.sign_v[i] = std::copysign(kPerPixel, v);
    part.row[i] = std::min(std::abs(u) * kPerPixel + RingTable::kMargin, last_row);
    part.column[i] = std::min(std::abs(v) * kPerPixel + RingTable::kMargin, last_column);
  }
}

/// Value, derivatives by u and v, and Laplacian, per step of the table.
VIBE_LANES void RingPattern::readTable(Part& part) const {
  const int stride = table_.stride();
  const float* table = table_.row(0);
  for (std::size_t i = 0; i < part.count; i += 2) {
    const int r = static_cast<int>(part.row[i]), c = static_cast<int>(part.column[i]);
    const int s = static_cast<int>(part.row[i + 1]), d = static_cast<int>(part.column[i + 1]);
    const Spline u(part.row[i] - static_cast<float>(r), part.row[i + 1] - static_cast<float>(s));
    const Spline v(part.column[i] - static_cast<float>(c), part.column[i + 1] - static_cast<float>(d));
    const float *p = table + (r - 1) * stride + (c - 1), *q = table + (s - 1) * stride + (d - 1);
    TwoFours mean{}, slope{}, bend{};
    for (int k = 0; k < 4; ++k, p += stride, q += stride) {
      const TwoFours row{p[0], p[1], p[2], p[3], q[0], q[1], q[2], q[3]};
      const Places all{k, k, k, k, k + 4, k + 4, k + 4, k + 4};
      mean += __builtin_shuffle(u.weight, all) * row;
      slope += __builtin_shuffle(u.first, all) * row;
      bend += __builtin_shuffle(u.second, all) * row;
    }
    const Places low{0, 8, 1, 9, 4, 12, 5, 13}, high{2, 10, 3, 11, 6, 14, 7, 15};
    const Places front{0, 1, 8, 9, 4, 5, 12, 13}, back{2, 3, 10, 11, 6, 7, 14, 15};
    const TwoFours value = mean * v.weight, by_v = mean * v.first, by_u = slope * v.weight;
    const TwoFours laplacian = bend * v.weight + mean * v.second;
    const TwoFours x = __builtin_shuffle(value, by_v, low) + __builtin_shuffle(value, by_v, high);
    const TwoFours y = __builtin_shuffle(by_u, laplacian, low) + __builtin_shuffle(by_u, laplacian, high);
    const TwoFours sums =
        __builtin_shuffle(x, y, front) + __builtin_shuffle(x, y, back);  // value, by_v, by_u, Laplacian
    part.value[i] = sums[0], part.by_v[i] = sums[1], part.by_u[i] = sums[2], part.laplacian[i] = sums[3];
    part.value[i + 1] = sums[4], part.by_v[i + 1] = sums[5], part.by_u[i + 1] = sums[6],
                   part.laplacian[i + 1] = sums[7];
  }
}

/// From the table's derivatives to those by the pose. A change of the variance of the blur adds half the Laplacian; one
/// of tilt or aspect also turns the motion on the marker.
VIBE_LANES void RingPattern::chain(const MarkerPose& pose, std::size_t begin, const Part& part,
                                   PatternValues& values) const {
  const std::size_t count = part.count;
  const TableFrame frame(pose);
  const auto ct = static_cast<float>(frame.cos_tilt), st = static_cast<float>(frame.sin_tilt);
  const auto cm = static_cast<float>(frame.cos_motion), sm = static_cast<float>(frame.sin_motion);
  const auto inverse_u = static_cast<float>(frame.inverse_u), inverse_v = static_cast<float>(frame.inverse_v);
  const auto turn_tilt = static_cast<float>(-frame.inverse_u * frame.inverse_v / (frame.motion * frame.motion));
  const auto keystone = static_cast<float>(pose.keystone), turn_aspect = cm * sm;
  const double blur = tableBlur(pose);
  const auto spread = static_cast<float>((blur * blur - table_.blur() * table_.blur()) / 2);
  const auto by_blur = static_cast<float>(pose.blur) * inverse_u * inverse_v;
  const auto variance = static_cast<float>(blur * blur);
  constexpr auto kPerArea = static_cast<float>(1 / (RingTable::kStep * RingTable::kStep));
  const auto out = [&](PoseIndex k) { return values.derivative[k].data() + begin; };
  float *value = values.value.data() + begin, *along = out(kAlong), *lateral = out(kLateral), *scale = out(kLogScale);
  float *aspect = out(kLogAspect), *tilt = out(kTilt), *by_width = out(kBlur), *trapeze = out(kKeystone);
  for (std::size_t i = 0; i < count; i += 4) {
    const Four x = loadFour(part.x + i), y = loadFour(part.y + i), laplacian = kPerArea * loadFour(part.laplacian + i);
    const Four by_u = loadFour(part.sign_u + i) * loadFour(part.by_u + i);
    const Four by_v = loadFour(part.sign_v + i) * loadFour(part.by_v + i);
    const Four turn = loadFour(part.v + i) * by_u - loadFour(part.u + i) * by_v;
    const Four by_p = (cm * by_u - sm * by_v) * inverse_u, by_q = (sm * by_u + cm * by_v) * inverse_v;
    const Four bend = keystone * x, shrink = 1 - bend;
    const Four by_x = (shrink - bend) * by_p - keystone * y * by_q, by_y = shrink * by_q;
    const Four grow_x = x * shrink * by_p, grow_y = y * shrink * by_q, spread_out = variance * laplacian;
    store(value + i, loadFour(part.value + i) + spread * laplacian);
    store(along + i, st * by_y - ct * by_x);
    store(lateral + i, -st * by_x - ct * by_y);
    store(scale + i, -grow_x - grow_y - spread_out);
    store(aspect + i, turn_aspect * turn - grow_x - 0.5F * spread_out);
    store(tilt + i, by_x * y - by_y * x + turn_tilt * turn);
    store(by_width + i, by_blur * laplacian);
    store(trapeze + i, -x * (x * by_p + y * by_q));
  }
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

}  // namespace vibe::vision
