#include "geometry/blood_shapes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "vibe_rviz_plugins/geometry/tube.hpp"

namespace vibe {
namespace {

using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;
constexpr double kGravity = 9.81;         // [m/s^2]
constexpr double kHeartRate = 72 / 60.0;  // [1/s]
constexpr double kMeanSpeed = 0.5;  // of blood leaving a small artery into gas [m/s]; rises some 13 mm; design choice
constexpr double kPulse = 0.3;      // part of the speed that pulses
constexpr double kFilm = 2.5e-3, kPool = 3.5e-3;                  // maximum height of blood on a wall, in a hollow [m]
constexpr double kMaxFilmRadius = 11e-3, kMaxPoolRadius = 15e-3;  // beyond, a curved wall hides the rest [m]
constexpr double kMinDrop = 8e-3, kMaxDrop = 50e-3;               // a jet falls this far below its wound [m]
constexpr double kFromCeiling = 35e-3;  // and at least this far from a wall that is overhead [m]
constexpr double kSteep = 0.5;          // cosine to gravity from which a wall is ceiling or floor
constexpr double kMinJet = 0.55e-3;     // [m]
constexpr double kBrown = 45;           // age at which stopped blood is half brown [s]
constexpr int kJetPoints = 24;

struct Shade {
  double red, green, blue, alpha;
};
constexpr Shade kBright{0.86, 0.02, 0.03, 0.97}, kDark{0.50, 0.01, 0.03, 0.92}, kClot{0.24, 0.06, 0.04, 0.62};

Shade mixed(const Shade& a, const Shade& b, double part) {
  return {a.red + part * (b.red - a.red), a.green + part * (b.green - a.green), a.blue + part * (b.blue - a.blue),
          a.alpha + part * (b.alpha - a.alpha)};
}

PackedColour packedOf(const Shade& shade, double alpha = 1) {
  return packed(shade.red, shade.green, shade.blue, shade.alpha * alpha);
}

Shade shadeOf(const Wound& wound) {
  if (wound.rate > 0) return wound.brisk ? kBright : kDark;
  return mixed(kDark, kClot, 0.5 + 0.5 * wound.age / (wound.age + kBrown));
}

/// Pseudo-random value from -1 to 1 for the number of a wound, so that outlines differ.
double wobble(int number, int which) {
  const double value = std::sin(12.9898 * (number + 1) + 78.233 * (which + 1)) * 43758.5453;
  return 2 * (value - std::floor(value)) - 1;
}

constexpr int kPuddleSides = 32, kPuddleRings = 6;  // rings of each half
constexpr double kUnderside = 0.6;                  // of the height

/// The outline of a puddle: where it ends around its middle, in units of the mean radius.
struct Outline {
  std::array<Vector3d, kPuddleSides> direction;  // unit, on the plane
  std::array<double, kPuddleSides> reach;
};

Outline outlineOf(const Puddle& puddle) {
  const Vector3d first = anyNormal(puddle.up), second = puddle.up.cross(first);
  std::array<double, 3> size, turn;
  for (int k = 0; k < 3; ++k) size[k] = 0.07 * wobble(puddle.number, k), turn[k] = kPi * wobble(puddle.number, k + 3);
  Outline outline;
  for (std::size_t s = 0; s < kPuddleSides; ++s) {
    const double angle = 2 * kPi * static_cast<double>(s) / kPuddleSides;
    outline.direction[s] = std::cos(angle) * first + std::sin(angle) * second;
    const double towards = std::max(0.0, puddle.creep.dot(outline.direction[s]));  // 0 to 1
    outline.reach[s] = 1 + 0.9 * towards * towards - 0.25 * puddle.creep.norm();
    for (int k = 0; k < 3; ++k) outline.reach[s] += size[k] * std::cos((k + 2) * angle + turn[k]);
  }
  return outline;
}

/// In units of the mean radius squared.
double areaOf(const Outline& outline) {
  double sum = 0;
  for (std::size_t k = 0; k < kPuddleSides; ++k) sum += outline.reach[k] * outline.reach[(k + 1) % kPuddleSides];
  return 0.5 * sum * std::sin(2 * kPi / kPuddleSides);
}

double puddleHeight(const Puddle& puddle) {
  return std::min(puddle.max_height, std::cbrt(puddle.volume * 3 / (2 * kPi)));
}

void addPuddleVertex(const Puddle& puddle, const Vector3d& out, double reach, double part, double height,
                     ColouredShape& shape) {
  // half an ellipsoid: part is the angle from the pole, 1 the outline; below it a flatter half that reaches into the
  // wall, so that a rim that stands off shows no hollow
  const double flat = std::sin(part * kPi / 2), up = std::cos(part * kPi / 2);
  if (part > 1) height *= kUnderside;
  const Eigen::Vector3f p = (puddle.centre + reach * flat * out + height * up * puddle.up).cast<float>();
  const Eigen::Vector3f n = (flat / reach * out + up / height * puddle.up).normalized().cast<float>();
  shape.vertices.push_back({{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}});
  shape.colours.push_back(std::abs(part - 1) > 0.01 ? puddle.middle : puddle.rim);
}

/// How far the blood of a wound falls: to the lowest known position of the wall.
double dropBelow(const Wound& wound, const SutureScene& scene, const Vector3d& down) {
  double lowest = 0;
  for (const SutureSet& set : scene.sets)
    for (const SutureBite& bite : set.bites) lowest = std::max(lowest, down.dot(bite.place - wound.place));
  const double towards_floor = wound.inward.dot(down);
  if (towards_floor > kSteep) lowest = std::max(lowest, kFromCeiling);
  return std::clamp(lowest, towards_floor < -kSteep ? 0.0 : kMinDrop, kMaxDrop);
}

void appendFilm(const Wound& wound, const BloodStyle& style, ColouredShape& shape) {
  const Shade shade = shadeOf(wound);
  Puddle film;
  film.centre = wound.place;
  film.up = wound.inward.norm() > 0.5 ? wound.inward : Vector3d(-style.down);
  film.creep = style.down - style.down.dot(film.up) * film.up;
  film.volume = wound.amount;
  film.max_height = kFilm;
  film.max_radius = kMaxFilmRadius;
  film.number = wound.number;
  film.middle = packedOf(shade);
  film.rim = packedOf(shade, 0.7);
  appendPuddle(film, shape);
}

void appendPool(const Wound& wound, const Vector3d& landing, const BloodStyle& style, ColouredShape& shape) {
  const Shade shade = mixed(kBright, kDark, 0.75);
  Puddle pool;
  pool.centre = landing;
  pool.up = -style.down;
  pool.creep = Vector3d::Zero();
  pool.volume = wound.amount;
  pool.max_height = kPool;
  pool.max_radius = kMaxPoolRadius;
  pool.number = wound.number + 100;
  pool.middle = packedOf(wound.rate > 0 ? shade : shadeOf(wound));
  pool.rim = packedOf(wound.rate > 0 ? shade : shadeOf(wound), 0.75);
  appendPuddle(pool, shape);
}

/// The jet is continuous at first and breaks up into drops.
void appendJet(const Wound& wound, const std::vector<Vector3d>& line, const BloodStyle& style, ColouredShape& shape) {
  constexpr std::size_t kWhole = 15;
  const double steady = std::sqrt(wound.rate / (kPi * kMeanSpeed));
  const double radius = std::max(kMinJet, steady) * std::sqrt(style.emphasis);
  std::vector<TubePoint> jet;
  for (std::size_t k = 0; k < kWhole; ++k) {
    const double swell = 1 + 0.35 * std::sin(2 * kPi * (0.19 * static_cast<double>(k) - style.time * 5));
    jet.push_back({line[k], radius * swell * (1 - 0.3 * static_cast<double>(k) / kWhole), packedOf(kBright)});
  }
  appendTube(jet, 8, shape);
  // drops differ in size and deviate from the path
  for (std::size_t k = kWhole; k < line.size(); ++k) {
    const auto number = static_cast<int>(3 * k);
    const Vector3d stray(wobble(wound.number, number), wobble(wound.number, number + 1),
                         wobble(wound.number, number + 2));
    const double size = 0.95 + 0.5 * wobble(wound.number + 7, number);
    appendBall(line[k] + 1.3 * radius * stray, radius * size, packedOf(kBright), 8, shape);
  }
}

void appendWound(const Wound& wound, const SutureScene& scene, const BloodStyle& style, ColouredShape& shape) {
  if (!wound.brisk) return appendFilm(wound, style, shape);
  const double drop = dropBelow(wound, scene, style.down);
  appendPool(wound, jetLanding(wound, drop, style), style, shape);
  Wound source = wound;
  source.amount = std::min(wound.amount, 5e-8);  // what clings to the wall around it
  appendFilm(source, style, shape);
  if (wound.rate > 0) appendJet(wound, jetLine(wound, drop, style), style, shape);
}

/// Path of blood with the mean initial speed, slightly oblique so that it does not fall back onto itself.
struct Flight {
  Vector3d leave;   // unit
  double duration;  // until it lands [s]

  Vector3d at(double t, double speed, const Vector3d& from, const Vector3d& down) const {
    return from + speed * t * leave + 0.5 * kGravity * t * t * down;
  }
};

Flight flightOf(const Wound& wound, double drop, const Vector3d& down) {
  const Vector3d inward = wound.inward.norm() > 0.5 ? wound.inward : Vector3d(-down);
  const Vector3d aside = Eigen::AngleAxisd(kPi * wobble(wound.number, 9), inward) * anyNormal(inward);
  const Vector3d leave = (inward + 0.45 * aside).normalized();
  const double rising = -kMeanSpeed * leave.dot(down);  // against gravity [m/s]
  return {leave, (rising + std::sqrt(rising * rising + 2 * kGravity * drop)) / kGravity};
}

}  // namespace

double jetSpeed(double time) {
  const double beat = time * kHeartRate, phase = 2 * kPi * (beat - std::floor(beat));
  return kMeanSpeed * (1 + kPulse * (std::sin(phase) + 0.5 * std::sin(2 * phase)));
}

std::vector<Vector3d> jetLine(const Wound& wound, double drop, const BloodStyle& style) {
  const Flight flight = flightOf(wound, drop, style.down);
  std::vector<Vector3d> line;
  for (int k = 0; k < kJetPoints; ++k) {
    const double t = flight.duration * k / (kJetPoints - 1);
    line.push_back(flight.at(t, jetSpeed(style.time - t), wound.place, style.down));
  }
  return line;
}

Vector3d jetLanding(const Wound& wound, double drop, const BloodStyle& style) {
  const Flight flight = flightOf(wound, drop, style.down);
  return flight.at(flight.duration, kMeanSpeed, wound.place, style.down);
}

double puddleRadius(const Puddle& puddle) {
  const double height = puddleHeight(puddle);
  if (!(height > 0)) return 0;
  return std::min(puddle.max_radius, std::sqrt(1.5 * puddle.volume / (height * areaOf(outlineOf(puddle)))));
}

void appendPuddle(const Puddle& puddle, ColouredShape& shape) {
  const double height = puddleHeight(puddle), radius = puddleRadius(puddle);
  if (!(radius > 0)) return;
  const Outline outline = outlineOf(puddle);
  const auto base = static_cast<std::uint32_t>(shape.vertices.size());
  for (int ring = 0; ring <= 2 * kPuddleRings; ++ring)
    for (std::size_t k = 0; k < kPuddleSides; ++k)
      addPuddleVertex(puddle, outline.direction[k], radius * outline.reach[k], static_cast<double>(ring) / kPuddleRings,
                      height, shape);
  for (std::uint32_t ring = 0; ring < 2 * kPuddleRings; ++ring)
    for (std::uint32_t k = 0; k < kPuddleSides; ++k) {
      const std::uint32_t upper = base + ring * kPuddleSides, lower = upper + kPuddleSides;
      const std::uint32_t beside = (k + 1) % kPuddleSides;
      shape.triangles.insert(shape.triangles.end(), {upper + k, lower + k, lower + beside});
      shape.triangles.insert(shape.triangles.end(), {upper + k, lower + beside, upper + beside});
    }
}

void appendBlood(const SutureScene& scene, const BloodStyle& style, ColouredShape& shape) {
  for (const Wound& wound : scene.wounds)
    if (wound.amount > 0 || wound.rate > 0) appendWound(wound, scene, style, shape);
}

}  // namespace vibe
