#include "synthetic/surface.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace vibe::vision {

std::unique_ptr<Surface> makeSurface(const CameraModel& camera, const SyntheticInstrument& instrument,
                                     const MarkerFrame& frame, const Eigen::Vector2d& reference, double aperture) {
  if (instrument.tag.cells > 0)
    return std::make_unique<TagSurface>(instrument.tag, PlaneMap(camera, frame, reference, aperture));
  if (const auto* ring = std::get_if<RingDesign>(&instrument.nominal.marker))
    return std::make_unique<RingSurface>(*ring, PlaneMap(camera, frame, reference, aperture));
  return std::make_unique<SleeveSurface>(std::get<SleeveDesign>(instrument.nominal.marker), camera, frame, reference,
                                         aperture);
}

PlaneMap::PlaneMap(const CameraModel& camera, const MarkerFrame& frame, const Eigen::Vector2d& reference,
                   double aperture) {
  const ViewRay ray(camera, reference);
  const double depth = frame.away.dot(frame.centre) / frame.scale;
  along_ = ray.part(frame.along * depth - frame.away * (frame.along.dot(frame.centre) / frame.scale));
  across_ = ray.part(frame.across * depth - frame.away * (frame.across.dot(frame.centre) / frame.scale));
  depth_ = ray.part(frame.away);
  const float half = static_cast<float>(aperture) / 2;
  step_x_[0] = along(half, 0) - along(-half, 0);
  step_x_[1] = across(half, 0) - across(-half, 0);
  step_y_[0] = along(0, half) - along(0, -half);
  step_y_[1] = across(0, half) - across(0, -half);
  aperture_ = std::sqrt(std::abs(step_x_[0] * step_y_[1] - step_x_[1] * step_y_[0]));
}

void RingSurface::row(const float* x, const float* y, int count, float* coverage, float* white) const {
  const auto outer = static_cast<float>(design_.outer_diameter / 2);
  const auto inner = static_cast<float>(design_.inner_diameter / 2);
  const auto half = static_cast<float>(design_.side / 2);
  const float inverse = 1 / map_.aperture();
  for (int i = 0; i < count; ++i) {
    const float u = map_.along(x[i], y[i]), v = map_.across(x[i], y[i]);
    coverage[i] = edgeShare(half - std::abs(u), inverse) * edgeShare(half - std::abs(v), inverse);
    const float radius = std::sqrt(u * u + v * v), outward = 1 / (radius + 1e-9F);
    const ApertureSpread spread = map_.spread(u * outward, v * outward);
    white[i] = 1 - positiveShare(outer - radius, spread) + positiveShare(inner - radius, spread);
  }
}

TagSurface::TagSurface(const SyntheticTag& tag, const PlaneMap& map)
    : tag_(tag), map_(map), cell_(static_cast<float>(tag.side / tag.cells)) {}

float TagSurface::cellWhite(int column, int row) const {
  if (column < 0 || row < 0 || column >= tag_.cells || row >= tag_.cells) return 1;
  return tag_.white[static_cast<std::size_t>(row * tag_.cells + column)] ? 1.0F : 0.0F;
}

void TagSurface::row(const float* x, const float* y, int count, float* coverage, float* white) const {
  const float width = map_.aperture() / cell_, inverse = cell_ / map_.aperture();
  const float middle = static_cast<float>(tag_.cells) / 2, half = middle + 1;
  for (int i = 0; i < count; ++i) {
    const float u = map_.along(x[i], y[i]) / cell_, v = map_.across(x[i], y[i]) / cell_;
    coverage[i] = edgeShare((half - std::abs(u)) * inverse, 1) * edgeShare((half - std::abs(v)) * inverse, 1);
    white[i] = 1;
    if (coverage[i] <= 0) continue;
    // The aperture overlaps at most 2 x 2 cells; shares of the right and the lower ones.
    const float left = u + middle - width / 2, top = v + middle - width / 2;
    const int column = static_cast<int>(std::floor(left)), row = static_cast<int>(std::floor(top));
    const float right = std::max(0.0F, left + width - static_cast<float>(column + 1)) * inverse;
    const float lower = std::max(0.0F, top + width - static_cast<float>(row + 1)) * inverse;
    const float upper_white = (1 - right) * cellWhite(column, row) + right * cellWhite(column + 1, row);
    const float lower_white = (1 - right) * cellWhite(column, row + 1) + right * cellWhite(column + 1, row + 1);
    white[i] = (1 - lower) * upper_white + lower * lower_white;
  }
}

namespace {

constexpr float kTurn = 6.28318530718F;
constexpr int kBlock = 16;         // samples that are treated alike
constexpr int kStrips = 4;         // that an aperture is cut into where the print turns away quickly
constexpr float kOutline = 0.75F;  // of the radius: from there on

/// To 2e-8, the same on every machine. Abramowitz and Stegun, "Handbook of Mathematical Functions", 4.4.46.
inline float arcSine(float s) {
  const float a = std::abs(s);
  float p = -0.0012624911F;
  p = p * a + 0.0066700901F;
  p = p * a - 0.0170881256F;
  p = p * a + 0.0308918810F;
  p = p * a - 0.0501743046F;
  p = p * a + 0.0889789874F;
  p = p * a - 0.2145988016F;
  p = p * a + 1.5707963050F;
  const float angle = 1.5707963268F - std::sqrt(1 - a) * p;
  return s < 0 ? -angle : angle;
}

/// Twice integrated from 0: the periodic function that is 1 where fract(t) < duty.
inline float dutyIntegral(float t, float duty) {
  constexpr float kAboveZero = 64;  // conversion to int rounds towards 0: keep it positive
  const auto turns = static_cast<float>(static_cast<int>(t + kAboveZero)) - kAboveZero;
  const float rest = t - turns, whole = turns * duty;
  const float within = rest < duty ? rest * rest / 2 : duty * (rest - duty / 2);
  return whole * (turns - 1) / 2 + whole * (1 - duty / 2) + whole * rest + within;
}

/// Mean of that function over a square aperture.
inline float dutyMean(float phase, const ApertureSpread& spread, float duty) {
  constexpr float kAboveZero = 64;
  const float t = phase - (static_cast<float>(static_cast<int>(phase + kAboveZero)) - kAboveZero);
  const float outer = (spread.wide + spread.narrow) / 2, inner = (spread.wide - spread.narrow) / 2;
  const float sum = dutyIntegral(t + outer, duty) - dutyIntegral(t + inner, duty) - dutyIntegral(t - inner, duty) +
                    dutyIntegral(t - outer, duty);
  const float mean = sum / (spread.wide * spread.narrow);
  return mean < 0 ? 0.0F : (mean > 1 ? 1.0F : mean);  // rounding
}

/// Part of the aperture [u - width / 2, u + width / 2] in [begin, end].
inline float overlap(float u, float half_width, float inverse_width, float begin, float end) {
  const float low = u - half_width < begin ? begin : u - half_width;
  const float high = u + half_width > end ? end : u + half_width;
  return high > low ? (high - low) * inverse_width : 0.0F;
}

}  // namespace

SleeveSurface::SleeveSurface(const SleeveDesign& design, const CameraModel& camera, const MarkerFrame& frame,
                             const Eigen::Vector2d& reference, double aperture)
    : design_(design), side_(static_cast<float>(aperture)) {
  const ViewRay ray(camera, reference);
  // The camera in coordinates of the rod: along it, and at a distance in the direction that faces the camera.
  const Eigen::Vector3d camera_place = -frame.centre / frame.scale;
  const double start = camera_place.dot(frame.along);
  const Eigen::Vector3d facing = (camera_place - start * frame.along).normalized();
  const double distance = camera_place.dot(facing);
  along_ = ray.part(frame.along);
  across_ = ray.part(frame.along.cross(facing));
  depth_ = ray.part(-facing);
  start_ = ray.part(-start * facing + distance * frame.along);
  distance_ = static_cast<float>(distance);
  rotation_ = static_cast<float>(std::remainder(frame.rotation, 2 * M_PI));
  radius_ = static_cast<float>(design.diameter / 2);
  half_length_ = static_cast<float>(design.length / 2);
  inverse_pitch_ = static_cast<float>(1 / design.helix_pitch);
  duty_ = static_cast<float>(design.helix_duty);
  for (const Bar& bar : design.bars) bars_.push_back({static_cast<float>(bar.begin), static_cast<float>(bar.end)});

  const double per_pixel = std::sqrt(ray.perPixel().x() * ray.perPixel().y()) * distance / -facing.dot(ray.centre());
  const Eigen::Vector2d picture =
      projectIdeal(camera, frame.centre + 1e-3 * frame.along) - projectIdeal(camera, frame.centre - 1e-3 * frame.along);
  direction_x_ = static_cast<float>(picture.x() / picture.norm());
  direction_y_ = static_cast<float>(picture.y() / picture.norm());
  const double obliquity = std::abs(frame.away.z());  // cosine of the slant against the image plane
  aperture_.across = static_cast<float>(aperture * per_pixel * frame.away.dot(-facing));
  aperture_.along = static_cast<float>(aperture * per_pixel / obliquity);
}

float SleeveSurface::helixBlack(float u, float phi, float along, const ApertureSpread& phase) const {
  const auto begin = static_cast<float>(design_.helix_begin), end = static_cast<float>(design_.helix_end);
  const float zone = overlap(u, along / 2, 1 / along, begin, end);
  return zone * dutyMean(u * inverse_pitch_ - (phi - rotation_) / kTurn + duty_ / 2, phase, duty_);
}

void SleeveSurface::strips(const float* x, const float* y, int count, float offset, float share, float* coverage,
                           float* white) const {
  const float inverse_radius = 1 / radius_, width = share * aperture_.across;
  const float right = -direction_y_ * offset * side_, down = direction_x_ * offset * side_;
  for (int i = 0; i < count; ++i) {
    // The ray leaves the camera at the slope k across; it meets the cylinder at the angle phi from the direction to
    // the camera, where sin(phi + atan k) = k distance / (radius sqrt(1 + k^2)).
    const float px = x[i] + right, py = y[i] + down;
    const float inverse_depth = 1 / depth_.at(px, py);
    const float k = across_.at(px, py) * inverse_depth, q = along_.at(px, py) * inverse_depth;
    const float length = 1 / std::sqrt(1 + k * k);
    const float beside = k * distance_ * length;
    float sine = beside * inverse_radius;
    sine = sine < -1 ? -1.0F : (sine > 1 ? 1.0F : sine);
    const float cosine = std::sqrt(1 - sine * sine);
    const float phi = arcSine(sine) - k * (1 - k * k / 3);
    const float height = radius_ * (cosine + sine * k) * length;  // above the rod's axis, towards the camera
    const float u = start_.at(px, py) * inverse_depth - q * height;

    // Derivatives across the rod grow towards its outline; there an aperture sees much of the print.
    const float steep = cosine < 0.05F ? 0.05F : cosine;
    const float bend = q * sine / steep * width;  // change of u from one side of the aperture to the other
    const float along = std::sqrt(aperture_.along * aperture_.along + bend * bend);
    const ApertureSpread phase =
        spread(aperture_.along * inverse_pitch_, bend * inverse_pitch_ - width * inverse_radius / (steep * kTurn));

    float black = helixBlack(u, phi, along, phase);
    for (const Edges& bar : bars_) black += overlap(u, along / 2, 1 / along, bar.begin, bar.end);
    white[i] = 1 - black;
    coverage[i] = edgeShare((radius_ - std::abs(beside)) / width, 1) *
                  overlap(u, along / 2, 1 / along, -half_length_, half_length_);
  }
}

bool SleeveSurface::nearOutline(const float* x, const float* y, int count) const {
  const auto ratio = [&](int i) { return across_.at(x[i], y[i]) / depth_.at(x[i], y[i]) * distance_ / radius_; };
  const float first = std::abs(ratio(0)), last = std::abs(ratio(count - 1));
  const float margin = aperture_.across / radius_;
  return std::max(first, last) > kOutline && std::min(first, last) < 1 + margin;
}

void SleeveSurface::row(const float* x, const float* y, int count, float* coverage, float* white) const {
  float part_coverage[kBlock], part_white[kBlock];
  for (int from = 0; from < count; from += kBlock) {
    const int length = std::min(kBlock, count - from);
    if (!nearOutline(x + from, y + from, length)) {
      strips(x + from, y + from, length, 0, 1, coverage + from, white + from);
      continue;
    }
    std::fill(coverage + from, coverage + from + length, 0.0F);
    std::fill(white + from, white + from + length, 0.0F);
    for (int k = 0; k < kStrips; ++k) {
      const float offset = (static_cast<float>(k) + 0.5F) / kStrips - 0.5F;
      strips(x + from, y + from, length, offset, 1.0F / kStrips, part_coverage, part_white);
      for (int i = 0; i < length; ++i) {
        coverage[from + i] += part_coverage[i] / kStrips;
        white[from + i] += part_coverage[i] * part_white[i] / kStrips;
      }
    }
    for (int i = from; i < from + length; ++i) white[i] = coverage[i] > 0 ? white[i] / coverage[i] : 1;
  }
}

}  // namespace vibe::vision
