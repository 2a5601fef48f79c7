#include "vibe_graphics/geometry/endoscope_optics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vibe::graphics {

namespace {

constexpr int kMinPicture = 16, kMaxPicture = 4096;  // [px]
constexpr int kSourceBorder = 2;  // pixels of it beyond the circle, so that its rim has neighbours to blend with
constexpr double kWide = 1.2;     // half field of view above which a second source pays; its drawing costs too [rad]

/// The square around a cone.
/// @param edge  tangent of its half angle
SquareSource squareAround(double edge, double focal_length, double sharpness, int max) {
  const double wanted = 2 * edge * focal_length * sharpness;
  SquareSource source;
  source.size =
      static_cast<int>(std::clamp(std::ceil(wanted) + 2 * kSourceBorder, 1.0 + 2 * kSourceBorder, double(max)));
  source.half_width = edge * source.size / (source.size - 2 * kSourceBorder);
  return source;
}

}  // namespace

std::string problemOf(const RoundCamera& camera) {
  // written so that NaN is a problem too
  if (!(camera.field_of_view >= kMinFieldOfView && camera.field_of_view <= kMaxFieldOfView))
    return "the field of view must be 10 to 170 degrees";
  for (const int size : {camera.width, camera.height})
    if (size < kMinPicture || size > kMaxPicture) return "width and height must be 16 to 4096 pixels";
  return "";
}

double focalLength(const RoundCamera& camera) {
  const double half = 0.5 * camera.field_of_view;
  return camera.radius() / (camera.lens == LensKind::Equidistant ? half : std::tan(half));
}

double radiusAt(const RoundCamera& camera, double angle) {
  return focalLength(camera) * (camera.lens == LensKind::Equidistant ? angle : std::tan(angle));
}

double angleAt(const RoundCamera& camera, double radius) {
  const double ratio = radius / focalLength(camera);
  return camera.lens == LensKind::Equidistant ? ratio : std::atan(ratio);
}

Eigen::Vector2d pixelOf(const RoundCamera& camera, const Eigen::Vector3d& point) {
  const Eigen::Vector2d aside = point.head<2>();
  const double distance = aside.norm();
  if (point.squaredNorm() == 0 || (camera.lens == LensKind::Rectilinear && point.z() <= 0))
    return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  if (distance == 0) return camera.middle();
  return camera.middle() + aside * (radiusAt(camera, std::atan2(distance, point.z())) / distance);
}

Eigen::Vector3d rayOf(const RoundCamera& camera, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d aside = pixel - camera.middle();
  const double radius = aside.norm();
  if (radius == 0) return Eigen::Vector3d::UnitZ();
  const double angle = angleAt(camera, radius);
  const double scale = std::sin(angle) / radius;
  return {aside.x() * scale, aside.y() * scale, std::cos(angle)};
}

Eigen::Vector3d placeOnLens(const Eigen::Vector3d& place) {
  constexpr double kBefore = 1e-4, kBeside = 3.8e-3,
                   kBehind = 5e-3;  // the lens is so far from the edge of the face [m]
  const bool within = place.z() < kBefore && place.z() > -kBehind && place.head<2>().norm() < kBeside;
  return within ? Eigen::Vector3d(place.x(), place.y(), kBefore) : place;
}

SquareSource sourceFor(const RoundCamera& camera, double sharpness, int max) {
  return squareAround(std::tan(0.5 * camera.field_of_view), focalLength(camera), sharpness, max);
}

LensSources sourcesFor(const RoundCamera& camera, double sharpness, int max) {
  if (camera.lens != LensKind::Equidistant || 0.5 * camera.field_of_view < kWide)
    return {sourceFor(camera, sharpness, max), {}};
  return {sourceFor(camera, LensSources::kRimSharpness * sharpness, max),
          squareAround(std::tan(LensSources::kMiddle), focalLength(camera), sharpness, max)};
}

CameraNumbers numbersOf(const RoundCamera& camera, double baseline) {
  const double f = focalLength(camera);
  const Eigen::Vector2d c = camera.middle();
  CameraNumbers numbers;
  // four coefficients of Kannala and Brandt (2006) that are 0 are exactly radius = f theta
  numbers.distortion_model = camera.lens == LensKind::Equidistant ? "equidistant" : "plumb_bob";
  numbers.d.assign(camera.lens == LensKind::Equidistant ? 4 : 5, 0.0);
  numbers.k = {f, 0, c.x(), 0, f, c.y(), 0, 0, 1};
  numbers.r = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  numbers.p = {f, 0, c.x(), -f * baseline, 0, f, c.y(), 0, 0, 0, 1, 0};
  return numbers;
}

namespace {

constexpr double kAhead = 0.5;                                         // light of a guide of strength 1 ahead
constexpr double kRadiation = 0.014387769;                             // second constant of Planck's law [m K]
constexpr std::array<double, 3> kWavelengths{610e-9, 550e-9, 465e-9};  // of red, green, blue [m]

/// Spectral radiance of a black body, but for a factor that depends on the wavelength alone.
double radiance(double wavelength, double temperature) {
  return 1 / std::expm1(kRadiation / (wavelength * temperature));
}

}  // namespace

Eigen::Vector3d lightColour(double temperature) {
  Eigen::Vector3d colour;
  for (int c = 0; c < 3; ++c) {
    const double wavelength = kWavelengths[static_cast<std::size_t>(c)];
    colour[c] = radiance(wavelength, temperature) / radiance(wavelength, EndoscopeLight::kBalanced);
  }
  return colour / colour[1];
}

Eigen::Vector2d coneOf(const EndoscopeLight& light, const LightGuide& guide) {
  return kAhead * guide.strength * Eigen::Vector2d(light.sideward, 1 - light.sideward);
}

namespace {

constexpr double kCloseEnough = 0.04;  // of the target: close enough to show the first picture
constexpr int kTries = 4;              // of the first picture
constexpr double kFollow = 0.3;  // of what is missing, at most, from picture to picture; all of it would overshoot

/// Stops that are missing. The level is about the square root of the exposure below the shoulder.
double missing(double level) {
  return 2 * std::log2(AutoExposure::kTarget / std::max(level, 0.01));
}

}  // namespace

void AutoExposure::see(double level, double time) {
  const double passed = time - time_;
  const bool again = begun_ && lost_ && passed == 0;
  const bool fresh = !begun_ || passed < 0 || passed > kGap || again;
  tries_ = again ? tries_ + 1 : 0;
  double stops = missing(level);
  if (!fresh) stops = std::clamp(kFollow * stops, -kRate * passed, kRate * passed);
  gain_ = std::clamp(gain_ * std::exp2(stops), kMinGain, kMaxGain);
  lost_ = fresh && tries_ + 1 < kTries && std::abs(level / kTarget - 1) > kCloseEnough;
  begun_ = true;
  time_ = time;
}

}  // namespace vibe::graphics
