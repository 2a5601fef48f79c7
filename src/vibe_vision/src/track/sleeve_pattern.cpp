#include "track/sleeve_pattern.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "track/arithmetic.hpp"

namespace vibe::vision {
namespace {

constexpr double kMinBlur = 0.25, kMaxBlur = 3.5;  // of the optics [px]
constexpr double kMinSleeveMotion = 0.5;    // replaces shorter ones, and their variance is taken off the blur [px]
constexpr float kLeastStripeMotion = 0.2F;  // half of it [px]: a turn may make up for the slide
constexpr double kRim = 0.88;               // of the radius: beyond, the print is seen too obliquely
constexpr double kNoticeableBend = 0.01;    // of the motion [px]
constexpr double kLongestBend = 0.7 * (BlurredLine::kMargin - MovingLine::kMaxHalfMotion);  // tables end there [px]
constexpr float kMaxSine = 0.97F;                 // of the angle around the rod: keeps derivatives finite
constexpr int kBarLevels = 4, kStripeLevels = 5;  // variances from the middle of the rod to the rim
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

SleevePattern::SleevePattern(const SleeveDesign& design, double pixels_per_metre, const MarkerView& view)
    : view_(view),
      radius_(design.diameter / 2 * pixels_per_metre),
      half_length_(design.length / 2 * pixels_per_metre),
      helix_begin_(static_cast<float>(design.helix_begin * pixels_per_metre)),
      helix_end_(static_cast<float>(design.helix_end * pixels_per_metre)),
      pitch_(static_cast<float>(design.helix_pitch * pixels_per_metre)),
      bars_(barsOf(design, pixels_per_metre), 0, 0.08, kPixelVariance),
      stripe_({stripeOf(design, pixels_per_metre)}, std::abs(design.helix_pitch) * pixels_per_metre, 0.002,
              kPixelVariance),
      moving_bars_(bars_, kBarLevels),
      moving_stripe_(stripe_, kStripeLevels),
      cut_(std::abs(pitch_), std::abs(pitch_) * design.helix_duty, stripe_) {
  measureEdges(barsOf(design, pixels_per_metre));
}
void SleevePattern::measureEdges(const std::vector<Interval>& bars) {
  for (int i = 0; i <= static_cast<int>(2 * half_length_) + 1; ++i) {
    double nearest = 2 * half_length_;
    for (const Interval& bar : bars)
      for (const double edge : {bar.begin, bar.end}) nearest = std::min(nearest, std::abs(i - half_length_ - edge));
    edge_distance_.push_back(static_cast<float>(nearest));
  }
}

std::array<bool, kPoseParameters> SleevePattern::observes() const {
  std::array<bool, kPoseParameters> observed{};
  for (const PoseIndex k : {kAlong, kLateral, kRotation, kLogScale, kTilt, kBlur, kSlant}) observed[k] = true;
  return observed;
}

/// Around a tilted sleeve there is more; see select().
Eigen::Vector2d SleevePattern::window(const MarkerPose& pose, double motion) const {
  const Eigen::Vector2d half = printWindow(pose, motion);
  const double cosine = std::abs(std::cos(pose.tilt)), sine = std::abs(std::sin(pose.tilt));
  return {cosine * half.x() + sine * half.y(), sine * half.x() + cosine * half.y()};
}

/// Along the rod and across it.
Eigen::Vector2d SleevePattern::printWindow(const MarkerPose& pose, double motion) const {
  const double scale = std::exp(pose.log_scale), blur = std::sqrt(pose.blur * pose.blur + kPixelVariance);
  const double side = radius_ * scale;
  const double lean = pose.slant + (pose.along - view_.principal_along) / view_.focal_length;  // bends the ends
  const double end = half_length_ * scale * std::cos(pose.slant) - side * std::abs(std::sin(lean)) - kEdgeReach * blur -
                     std::abs(motion) / 2;
  return {std::max(end, 0.3 * half_length_), std::max(std::min(kRim * side, side - 2.9 * blur), 0.4 * side)};
}

void SleevePattern::compose(MovingLine& line, double low, double high, double half_motion) const {
  low = std::max(low, 0.3 * high);
  line.compose(static_cast<float>(low), static_cast<float>(high), static_cast<float>(std::max(half_motion, 0.1)),
               parts_);
}

/// Tables for the middle of the rod and for its rim. Slopes are those of a line of sight that is not oblique.
void SleevePattern::prepare(const MarkerPose& pose, const MarkerMotion& motion, bool rough) {
  rough_ = rough;
  motion_ = std::min(std::abs(motion.length), 2.0 * MovingLine::kMaxHalfMotion);
  turn_ = std::copysign(1.0, motion.length) * motion.turn;
  const double most = std::min(MotionParts::kMostBend * motion_ / 2, kLongestBend);
  const double bend = std::clamp(motion.bend, -most, most);
  parts_ = MotionParts(static_cast<float>(std::abs(bend) < kNoticeableBend ? 0 : 2 * bend / motion_));
  const View view = viewOf(pose, motion_);
  const double lean = std::tan(pose.slant + (pose.along - view_.principal_along) / view_.focal_length);
  const double rim = 1 / std::sqrt(1 - kRim * kRim), turn = pitch_ / kTurn / radius_, bow = std::abs(lean) * kRim * rim;
  const double stretch = 1 + lean * lean, swing = bow + std::abs(turn) * rim, variance = view.variance;
  const double half = view.half_motion * view.tilt_cosine * std::sqrt(stretch), tilt = std::abs(view.tilt_sine);
  // On a tilted rod the motion is longer in some rows and shorter in others.
  const double bars_more = 2.0 / 3 * half * half * tilt * bow;
  const double stripe_more = 2.0 / 3 * half * half * tilt * (bow + std::abs(turn) * (rim - 1) / 2);
  compose(moving_bars_, variance * stretch - bars_more, variance * (stretch + bow * bow) + bars_more, half);
  compose(moving_stripe_, variance * (stretch + turn * turn) - stripe_more,
          variance * (stretch + swing * swing) + stripe_more,
          std::max<double>(half + half * view.tilt_sine * turn * (1 + rim) / 2 + view.spin, kLeastStripeMotion));
}

SleevePattern::View SleevePattern::viewOf(const MarkerPose& pose, double motion_length) const {
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
  view.slope_along = static_cast<float>(slope.x());
  view.slope_across = static_cast<float>(slope.y());
  const Eigen::Vector2d camera = Eigen::Vector2d(cosine - slope.x() * sine, slope.y()).normalized();
  view.turn_cosine = static_cast<float>(camera.x());
  view.turn_sine = static_cast<float>(camera.y());
  const double motion = std::max(motion_length, kMinSleeveMotion), blur = std::clamp(pose.blur, kMinBlur, kMaxBlur);
  const double variance = blur * blur + kPixelVariance - (motion * motion - motion_length * motion_length) / 12;
  view.half_motion = static_cast<float>(motion / 2 / scale);
  view.spin = static_cast<float>(-pitch_ / kTurn * turn_ / 2);
  view.variance = static_cast<float>(variance / (scale * scale));
  view.by_blur = static_cast<float>(2 * blur / variance);
  return view;
}

void SleevePattern::evaluate(const MarkerPose& pose, const PixelBlock& pixels, PatternValues& values) {
  const View view = viewOf(pose, motion_);
  Part part;
  for (std::size_t begin = 0; begin < pixels.padded(); begin += Part::kSize) {
    part.size = std::min(Part::kSize, pixels.padded() - begin);
    placePixels(view, pixels, begin, part);
    look(part);
    chain(view, begin, part, values);
  }
}

/// The last part may have fewer pixels: its last one is repeated.
void SleevePattern::placePixels(const View& view, const PixelBlock& pixels, std::size_t begin, Part& part) const {
  const float *along = pixels.along.data() + begin, *lateral = pixels.lateral.data() + begin;
  float last_along[Part::kSize], last_lateral[Part::kSize];
  if (part.size < Part::kSize) {
    for (std::size_t i = 0; i < Part::kSize; ++i) {
      last_along[i] = along[std::min(i, part.size - 1)];
      last_lateral[i] = lateral[std::min(i, part.size - 1)];
    }
    along = last_along, lateral = last_lateral;
  }
  place(view, along, lateral, part);
  unroll(view, part);
  spread(view, part);
}

/// Where the line of sight of each pixel meets the rod. In the frame of the rod (along it, across it, and the normal of
/// both that looks to the camera) the line has the direction q; it passes the axis at the distance `offset` times |q|
/// and meets the surface `rise` before the depth of the centre.
VIBE_LANES void SleevePattern::place(const View& pose, const float* __restrict along, const float* __restrict lateral,
                                     Part& __restrict part) const {
  const View view = pose;
  const auto radius = static_cast<float>(radius_), inverse_radius = 1 / radius;
  for (std::size_t i = 0; i < Part::kSize; ++i) {
    const float da = along[i] - view.along, dl = lateral[i] - view.lateral;
    const float x = (da * view.tilt_cosine + dl * view.tilt_sine) * view.inverse_scale;
    const float v = (dl * view.tilt_cosine - da * view.tilt_sine) * view.inverse_scale;
    const float across = view.slope_across + view.bend * v, depth = view.slant_sine * x;
    const float normal = view.slant_sine * (view.slope_along + view.bend * x) - view.slant_cosine;
    const float length = across * across + normal * normal, inverse_length = 1 / length;
    const float offset = v * normal - depth * across, square = offset * offset * inverse_length;
    const float most = kMaxSine * kMaxSine * radius * radius;
    const float chord = std::sqrt(length * (radius * radius - (square < most ? square : most)));
    const float rise = (v * across + depth * normal + chord) * inverse_length;
    const float sine = (v - rise * across) * inverse_radius, cosine = (depth - rise * normal) * inverse_radius;
    float turned = sine * view.turn_cosine + cosine * view.turn_sine;
    turned = turned > kMaxSine ? kMaxSine : turned;
    turned = turned < -kMaxSine ? -kMaxSine : turned;
    part.x[i] = x;
    part.v[i] = v;
    part.rise[i] = rise;
    part.oblique[i] = radius / chord;
    part.sine[i] = sine;
    part.cosine[i] = cosine;
    part.phi[i] = std::copysign(arcSine(std::abs(turned), std::sqrt(1 - std::abs(turned))), turned) - view.rotation;
  }
}

/// Places on the print, and how fast they change in the picture.
VIBE_LANES void SleevePattern::unroll(const View& pose, Part& __restrict part) const {
  const View view = pose;
  const auto radius = static_cast<float>(radius_), inverse_radius = 1 / radius;
  const float advance = pitch_ / kTurn, half_variance = 0.5F * view.variance;
  for (std::size_t i = 0; i < Part::kSize; ++i) {
    const float x = part.x[i], sine = part.sine[i], cosine = part.cosine[i], oblique = part.oblique[i];
    const float slope = view.slope_along + view.bend * x;
    const float bow = view.slant_sine + view.slant_cosine * slope, normal = view.slant_sine * slope - view.slant_cosine;
    const float stretch = view.slant_cosine + oblique * cosine * view.slant_sine * bow, steep = -oblique * normal;
    const float curve = half_variance * inverse_radius * steep * steep * steep;
    const float u = view.slant_cosine * x - part.rise[i] * bow + curve * bow * stretch;
    part.u[i] = u;
    part.w[i] = u - advance * (part.phi[i] + curve * sine * inverse_radius);
    part.stretch[i] = stretch;
    part.lean[i] = oblique * sine * bow;
    part.turn[i] = advance * inverse_radius * steep;
    part.by_slant[i] = u * bow - radius * cosine;
  }
}

VIBE_LANES void SleevePattern::spread(const View& pose, Part& __restrict part) const {
  const View view = pose;
  const float begin = helix_begin_, end = helix_end_;
  for (std::size_t i = 0; i < Part::kSize; ++i) {
    const float stretch = part.stretch[i], lean = part.lean[i], turn = part.turn[i], swing = lean - turn;
    const float half_motion = view.half_motion * (view.tilt_cosine * stretch - view.tilt_sine * lean);
    const float variance = view.variance * (stretch * stretch + lean * lean);
    const float reach = kEdgeReach * std::sqrt(variance) + half_motion, low = part.u[i] - reach,
                high = part.u[i] + reach;
    part.half_motion[i] = half_motion;
    const float stripe_half = half_motion + view.half_motion * view.tilt_sine * turn + view.spin;
    part.stripe_half_motion[i] = stripe_half < kLeastStripeMotion ? kLeastStripeMotion : stripe_half;
    part.bar_variance[i] = variance;
    part.stripe_variance[i] = view.variance * (stretch * stretch + swing * swing);
    part.cut_variance[i] = view.variance * turn * turn;
    part.inside[i] = (low > begin ? 1.0F : 0.0F) * (high < end ? 1.0F : 0.0F);
    part.outside[i] = (high < begin ? 1.0F : 0.0F) + (low > end ? 1.0F : 0.0F);
  }
}

void SleevePattern::look(Part& part) const {
  moving_bars_.look({part.u, part.bar_variance, part.half_motion}, Part::kSize,
                    {part.bars, part.bars_slope, part.bars_bend});
  moving_stripe_.look({part.w, part.stripe_variance, part.stripe_half_motion}, Part::kSize,
                      {part.stripe, part.stripe_slope, part.stripe_bend});
  for (std::size_t i = 0; i < Part::kSize; ++i) {
    const float inside = part.inside[i];
    part.value[i] = part.bars[i] + inside * part.stripe[i];
    part.by_w[i] = inside * part.stripe_slope[i];
    part.by_u[i] = part.bars_slope[i] + part.by_w[i];
    part.by_blur[i] =
        0.5F * (part.bar_variance[i] * part.bars_bend[i] + inside * part.stripe_variance[i] * part.stripe_bend[i]);
  }
  for (std::size_t i = 0; i < part.size; ++i)
    if (part.inside[i] + part.outside[i] == 0) cutAt(i, part);
}

VIBE_LANES void SleevePattern::chain(const View& pose, std::size_t begin, const Part& part,
                                     PatternValues& values) const {
  const View view = pose;
  const float c = view.tilt_cosine * view.inverse_scale, s = view.tilt_sine * view.inverse_scale;
  const float advance = pitch_ / kTurn, swing = view.slant_cosine * view.slope_across, per_blur = view.by_blur;
  Eight* out[kPoseParameters];
  for (const PoseIndex k : {kAlong, kLateral, kRotation, kLogScale, kTilt, kBlur, kSlant})
    out[k] = reinterpret_cast<Eight*>(values.derivative[k].data() + begin);
  Eight* value = reinterpret_cast<Eight*>(values.value.data() + begin);
  for (std::size_t i = 0; i < part.size; i += kLanes, ++value) {
    const Eight x = *reinterpret_cast<const Eight*>(part.x + i), v = *reinterpret_cast<const Eight*>(part.v + i);
    const Eight by_u = *reinterpret_cast<const Eight*>(part.by_u + i);
    const Eight by_w = *reinterpret_cast<const Eight*>(part.by_w + i);
    const Eight by_blur = *reinterpret_cast<const Eight*>(part.by_blur + i);
    const Eight by_x = by_u * *reinterpret_cast<const Eight*>(part.stretch + i);
    const Eight by_v =
        by_u * *reinterpret_cast<const Eight*>(part.lean + i) - by_w * *reinterpret_cast<const Eight*>(part.turn + i);
    *value = 1 - *reinterpret_cast<const Eight*>(part.value + i);
    *out[kAlong]++ = c * by_x - s * by_v;
    *out[kLateral]++ = s * by_x + c * by_v;
    *out[kRotation]++ = -advance * by_w;
    *out[kLogScale]++ = x * by_x + v * by_v + 2 * by_blur;
    *out[kTilt]++ = x * by_v - v * by_x + swing * *reinterpret_cast<const Eight*>(part.rise + i) * by_u;
    *out[kBlur]++ = -per_blur * by_blur;
    *out[kSlant]++ = -by_u * *reinterpret_cast<const Eight*>(part.by_slant + i);
  }
}

}  // namespace vibe::vision
