#include "track/sleeve_pattern.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace vibe {
namespace {

constexpr double kPixelVariance = 1.0 / 12;        // of the area of a pixel [px^2]
constexpr double kMinBlur = 0.25, kMaxBlur = 3.5;  // of the optics [px]
constexpr double kMinMotion = 0.5;  // shorter ones are replaced by this, and their variance taken off the blur [px]
constexpr double kRim = 0.88;       // of the radius: beyond, the print is seen too obliquely
constexpr float kReach = 3.4F;      // standard deviations after which an edge is over
constexpr float kMaxSine = 0.97F;   // of the angle around the rod: keeps derivatives finite
constexpr float kTurn = 6.28318530718F;

/// To 2e-8, for 0 <= s < 1. Abramowitz and Stegun, "Handbook of Mathematical Functions", 4.4.46.
inline float arcSine(float s, float cosine_root) {
  float p = -0.0012624911F;
  p = p * s + 0.0066700901F;
  p = p * s - 0.0170881256F;
  p = p * s + 0.0308918810F;
  p = p * s - 0.0501743046F;
  p = p * s + 0.0889789874F;
  p = p * s - 0.2145988016F;
  p = p * s + 1.5707963050F;
  return 1.5707963268F - cosine_root * p;
}

std::vector<Interval> barsOf(const SleeveDesign& design, double pixels_per_metre) {
  std::vector<Interval> bars;
  for (const Bar& bar : design.bars) bars.push_back({bar.begin * pixels_per_metre, bar.end * pixels_per_metre});
  return bars;
}

Interval stripeOf(const SleeveDesign& design, double pixels_per_metre) {
  const double half = std::abs(design.helix_pitch) * design.helix_duty / 2 * pixels_per_metre;
  return {-half, half};
}

}  // namespace

/// A pose, ready for use.
struct SleevePattern::View {
  float along, lateral, rotation;
  float tilt_cosine, tilt_sine, inverse_scale;
  float slant_cosine, slant_sine;
  float bend;         ///< of the line of sight per pixel: 1 / focal length; also 1 / distance to the camera [1/px]
  float principal_x;  ///< of the camera, along the tilted marker from its centre [px]
  float across;       ///< slope of the line of sight to the centre, across the tilted marker
  float turn;         ///< of the direction to the camera around the rod against the normal of the image [rad]
  float half_motion;  ///< in pixels of the print, where the camera looks at it at a right angle
  float variance;     ///< of optics and pixel in pixels of the print, less what a lengthened motion has
  float by_blur;      ///< relative change of `variance` with the blur [1/px]
};

/// Some pixels. Lengths are in pixels of the print.
struct SleevePattern::Part {
  static constexpr std::size_t kSize = 64;
  std::size_t size = kSize;
  alignas(64) float x[kSize], v[kSize];           ///< along and across in the picture
  alignas(64) float u[kSize], w[kSize];           ///< along the print, from its centre and from a black part's centre
  alignas(64) float stretch[kSize], lean[kSize];  ///< of u against x; change of u across: lean, of the stripe: swing
  alignas(64) float swing[kSize];
  alignas(64) float by_slant[kSize];  ///< change of u
  alignas(64) float half_motion[kSize], stripe_half_motion[kSize];
  alignas(64) float bar_variance[kSize], stripe_variance[kSize], cut_variance[kSize];
  alignas(64) float value[kSize], by_u[kSize], by_w[kSize], by_blur[kSize];
};

/// Blackness and its derivatives: by a shift of all, by a shift of the stripe alone, and by the relative change of the
/// blur's variance.
struct SleevePattern::Blackness {
  float value = 0, by_u = 0, by_w = 0, by_blur = 0;
};

SleevePattern::SleevePattern(const SleeveDesign& design, double pixels_per_metre, const MarkerView& view)
    : view_(view),
      radius_(design.diameter / 2 * pixels_per_metre),
      half_length_(design.length / 2 * pixels_per_metre),
      helix_begin_(static_cast<float>(design.helix_begin * pixels_per_metre)),
      helix_end_(static_cast<float>(design.helix_end * pixels_per_metre)),
      pitch_(static_cast<float>(design.helix_pitch * pixels_per_metre)),
      bars_left_(static_cast<float>(-half_length_)),
      bars_right_(static_cast<float>(half_length_)),
      bars_(barsOf(design, pixels_per_metre), 0, 0.08, kPixelVariance),
      stripe_({stripeOf(design, pixels_per_metre)}, std::abs(design.helix_pitch) * pixels_per_metre, 0.002,
              kPixelVariance),
      cut_(std::abs(pitch_), std::abs(pitch_) * design.helix_duty, stripe_) {
  for (const Interval& bar : barsOf(design, pixels_per_metre)) {
    if (bar.end <= helix_begin_) bars_left_ = std::max(bars_left_, static_cast<float>(bar.end));
    if (bar.begin >= helix_end_) bars_right_ = std::min(bars_right_, static_cast<float>(bar.begin));
  }
}

std::array<bool, kPoseParameters> SleevePattern::observes() const {
  std::array<bool, kPoseParameters> observed{};
  for (const PoseIndex k : {kAlong, kLateral, kRotation, kLogScale, kTilt, kBlur, kSlant}) observed[k] = true;
  return observed;
}

Eigen::Vector2d SleevePattern::window(const MarkerPose& pose, double motion) const {
  const double scale = std::exp(pose.log_scale), blur = std::sqrt(pose.blur * pose.blur + kPixelVariance);
  const double side = radius_ * scale;
  const double lean = pose.slant + (pose.along - view_.principal_along) / view_.focal_length;  // bends the ends
  const double end = half_length_ * scale * std::cos(pose.slant) - side * std::abs(std::sin(lean)) - kReach * blur -
                     std::abs(motion) / 2;
  return {std::max(end, 0.3 * half_length_), std::max(std::min(kRim * side, side - 2.9 * blur), 0.4 * side)};
}

Eigen::Vector2d SleevePattern::maxWindow() const {
  return Eigen::Vector2d(half_length_, radius_) * 1.2;
}

void SleevePattern::prepare(const MarkerPose&, double motion) {
  motion_ = std::abs(motion);
}

SleevePattern::View SleevePattern::viewOf(const MarkerPose& pose) const {
  View view{};
  const double scale = std::exp(pose.log_scale);
  view.along = static_cast<float>(pose.along);
  view.lateral = static_cast<float>(pose.lateral);
  view.rotation = static_cast<float>(std::remainder(pose.rotation, 2 * M_PI));
  view.tilt_cosine = static_cast<float>(std::cos(pose.tilt));
  view.tilt_sine = static_cast<float>(std::sin(pose.tilt));
  view.inverse_scale = static_cast<float>(1 / scale);
  view.slant_cosine = static_cast<float>(std::cos(pose.slant));
  view.slant_sine = static_cast<float>(std::sin(pose.slant));
  view.bend = static_cast<float>(scale / view_.focal_length);
  const Eigen::Vector2d principal =
      Eigen::Rotation2Dd(-pose.tilt) *
      Eigen::Vector2d(view_.principal_along - pose.along, view_.principal_lateral - pose.lateral);
  const Eigen::Vector2d slope = -principal / view_.focal_length;
  const double sine = std::sin(pose.slant), cosine = std::cos(pose.slant);
  view.principal_x = static_cast<float>(principal.x() / scale);
  view.across = static_cast<float>(slope.y() * cosine);
  view.turn = static_cast<float>(std::atan(slope.y() / (cosine - slope.x() * sine)) - std::atan(slope.y() * cosine));
  const double motion = std::max(motion_, kMinMotion), blur = std::clamp(pose.blur, kMinBlur, kMaxBlur);
  const double variance = blur * blur + kPixelVariance - (motion * motion - motion_ * motion_) / 12;
  view.half_motion = static_cast<float>(motion / 2 / scale);
  view.variance = static_cast<float>(variance / (scale * scale));
  view.by_blur = static_cast<float>(2 * blur / variance);
  return view;
}

void SleevePattern::evaluate(const MarkerPose& pose, const PixelBlock& pixels, PatternValues& values) {
  const View view = viewOf(pose);
  Part part;
  for (std::size_t begin = 0; begin < pixels.padded(); begin += Part::kSize) {
    part.size = std::min(Part::kSize, pixels.padded() - begin);
    place(view, pixels, begin, part);
    look(part);
    chain(view, begin, part, values);
  }
}

/// Where the line of sight of each pixel meets the rod. Of the angle phi around the rod and the place u along it, the
/// picture shows x + t X = u cos(slant) + R cos(phi) sin(slant), where X is the depth of the place, t the slope of the
/// line of sight; and likewise across.
void SleevePattern::place(const View& view, const PixelBlock& pixels, std::size_t begin, Part& part) const {
  const auto radius = static_cast<float>(radius_), inverse_radius = 1 / radius, advance = pitch_ / kTurn;
  const float lift = view.across * view.slant_sine / (view.slant_cosine * view.slant_cosine);
  for (std::size_t i = 0; i < part.size; ++i) {
    const float da = pixels.along[begin + i] - view.along, dl = pixels.lateral[begin + i] - view.lateral;
    const float x = (da * view.tilt_cosine + dl * view.tilt_sine) * view.inverse_scale;
    const float v = (dl * view.tilt_cosine - da * view.tilt_sine) * view.inverse_scale;
    const float slope = view.bend * (x - view.principal_x);
    const float across = view.slant_sine + view.slant_cosine * slope;
    const float stretch = 1 / (view.slant_cosine - view.slant_sine * slope);

    float sine = (v + lift * x) * inverse_radius;
    float square = sine * sine;
    square = square > kMaxSine * kMaxSine ? kMaxSine * kMaxSine : square;
    const float height = radius * view.slant_cosine * std::sqrt(1 - square);
    sine *= 1 + view.bend * (x * view.slant_sine - height);
    float size = std::abs(sine);
    size = size > kMaxSine ? kMaxSine : size;
    sine = sine < 0 ? -size : size;
    const float cosine = std::sqrt(1 - size * size), angle = arcSine(size, std::sqrt(1 - size));
    const float phi = sine < 0 ? -angle : angle;

    const float per_cosine = 1 / cosine, bow = across * stretch;
    const float curve = 0.5F * view.variance * inverse_radius * per_cosine * per_cosine * per_cosine;
    const float lean = bow * (sine * per_cosine - view.across), turn = advance * inverse_radius * per_cosine;
    const float top = radius * (cosine + view.across * sine);  // of the rod above its axis, towards the camera
    const float u = (x - top * across) * stretch + curve * bow;
    part.x[i] = x;
    part.v[i] = v;
    part.u[i] = u;
    part.w[i] = u - advance * (phi + view.turn - view.rotation + curve * sine * inverse_radius);
    part.stretch[i] = stretch;
    part.lean[i] = lean;
    part.swing[i] = lean - turn;
    part.by_slant[i] = u * bow - top;
    part.half_motion[i] = view.half_motion * (view.tilt_cosine * stretch - view.tilt_sine * lean);
    part.stripe_half_motion[i] = view.half_motion * (view.tilt_cosine * stretch - view.tilt_sine * (lean - turn));
    part.bar_variance[i] = view.variance * (stretch * stretch + lean * lean);
    part.stripe_variance[i] = view.variance * (stretch * stretch + (lean - turn) * (lean - turn));
    part.cut_variance[i] = view.variance * turn * turn;
  }
}

void SleevePattern::add(const Blackness& other, float sign, Blackness& sum) {
  sum.value += sign * other.value;
  sum.by_u += sign * other.by_u;
  sum.by_w += sign * other.by_w;
  sum.by_blur += sign * other.by_blur;
}

void SleevePattern::look(Part& part) const {
  for (std::size_t i = 0; i < part.size; ++i) {
    const float reach = kReach * std::sqrt(part.bar_variance[i]) + part.half_motion[i], u = part.u[i];
    Blackness black;
    if (u - reach < bars_left_ || u + reach > bars_right_) black = barsAt(part, i);
    if (u + reach > helix_begin_ && u - reach < helix_end_) {
      add(u + reach < helix_end_ ? stripeAt(part, i) : cutStripeAt(part, i, helix_end_), 1, black);
      if (u - reach < helix_begin_) add(cutStripeAt(part, i, helix_begin_), -1, black);
    }
    part.value[i] = black.value;
    part.by_u[i] = black.by_u;
    part.by_w[i] = black.by_w;
    part.by_blur[i] = black.by_blur;
  }
}

SleevePattern::Blackness SleevePattern::barsAt(const Part& part, std::size_t i) const {
  const float half = part.half_motion[i], variance = part.bar_variance[i], inverse = 0.5F / half;
  const BlurredLine::Entry a = bars_.at(part.u[i] - half, variance), b = bars_.at(part.u[i] + half, variance);
  return {(b.integral - a.integral) * inverse, (b.value - a.value) * inverse, 0,
          0.5F * variance * (b.slope - a.slope) * inverse};
}

SleevePattern::Blackness SleevePattern::stripeAt(const Part& part, std::size_t i) const {
  const float half = part.stripe_half_motion[i], variance = part.stripe_variance[i], inverse = 0.5F / half;
  const BlurredLine::Entry a = stripe_.at(part.w[i] - half, variance), b = stripe_.at(part.w[i] + half, variance);
  const float by_w = (b.value - a.value) * inverse;
  return {(b.integral - a.integral) * inverse + stripe_.mean(), by_w, by_w,
          0.5F * variance * (b.slope - a.slope) * inverse};
}

/// The stripe up to a cut.
SleevePattern::Blackness SleevePattern::cutStripeAt(const Part& part, std::size_t i, float cut) const {
  const float half = part.half_motion[i], inverse = 0.5F / half, along = part.bar_variance[i];
  const float y = part.u[i] - cut, phase = part.w[i] - y;
  const CutStripe::Entry a = cut_.at(y - half, phase, along, part.cut_variance[i], part.stripe_variance[i]);
  const CutStripe::Entry b = cut_.at(y + half, phase, along, part.cut_variance[i], part.stripe_variance[i]);
  return {(b.integral - a.integral) * inverse, (b.value - a.value) * inverse, (b.by_shift - a.by_shift) * inverse,
          0.5F * along * (b.slope - a.slope) * inverse};
}

void SleevePattern::chain(const View& view, std::size_t begin, const Part& part, PatternValues& values) const {
  const float c = view.tilt_cosine * view.inverse_scale, s = view.tilt_sine * view.inverse_scale;
  const float advance = pitch_ / kTurn;
  const auto out = [&](PoseIndex k) { return values.derivative[k].data() + begin; };
  float *along = out(kAlong), *lateral = out(kLateral), *rotation = out(kRotation), *scale = out(kLogScale);
  float *tilt = out(kTilt), *blur = out(kBlur), *slant = out(kSlant), *value = values.value.data() + begin;
  for (std::size_t i = 0; i < part.size; ++i) {
    const float x = part.x[i], v = part.v[i], black_u = part.by_u[i], black_w = part.by_w[i];
    const float by_x = black_u * part.stretch[i];
    const float by_v = black_u * part.lean[i] + black_w * (part.swing[i] - part.lean[i]);
    value[i] = 1 - part.value[i];
    along[i] = c * by_x - s * by_v;
    lateral[i] = s * by_x + c * by_v;
    rotation[i] = -advance * black_w;
    scale[i] = x * by_x + v * by_v + 2 * part.by_blur[i];
    tilt[i] = x * by_v - v * by_x;
    blur[i] = -view.by_blur * part.by_blur[i];
    slant[i] = -black_u * part.by_slant[i];
  }
}

}  // namespace vibe
