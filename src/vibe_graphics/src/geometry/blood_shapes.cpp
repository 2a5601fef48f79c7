#include "vibe_graphics/geometry/blood_shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "geometry/blood_on_wall.hpp"
#include "vibe_graphics/geometry/blood_colour.hpp"
#include "vibe_graphics/geometry/tube.hpp"

namespace vibe::graphics {

namespace {

using Eigen::Vector3d;

constexpr double kMaxFilmHeight = 2.5e-3, kMaxPoolHeight = 3.5e-3;  // of blood on a wall, in a hollow [m]
constexpr double kMaxFilmRadius = 11e-3, kMaxPoolRadius = 15e-3;    // beyond, a curved wall hides the rest [m]
constexpr double kMinDrop = 8e-3, kMaxDrop = 50e-3;                 // a jet falls this far below its wound [m]
constexpr double kFromCeiling = 35e-3;  // and at least this far from a wall that is overhead [m]
constexpr double kSteep = 0.5;          // cosine to gravity from which a wall is ceiling or floor

BloodShade shadeOf(const Wound& wound) {
  if (wound.rate > 0) return wound.brisk ? kBrightBlood : kDarkBlood;
  return mixed(kDarkBlood, kClottedBlood, brownOf(wound));
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
  for (int k = 0; k < 3; ++k) size[k] = 0.07 * wobble(puddle.number, k), turn[k] = M_PI * wobble(puddle.number, k + 3);
  Outline outline;
  for (std::size_t s = 0; s < kPuddleSides; ++s) {
    const double angle = 2 * M_PI * static_cast<double>(s) / kPuddleSides;
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
  return 0.5 * sum * std::sin(2 * M_PI / kPuddleSides);
}

double puddleHeight(const Puddle& puddle) {
  return std::min(puddle.max_height, std::cbrt(puddle.volume * 3 / (2 * M_PI)));
}

void addPuddleVertex(const Puddle& puddle, const Vector3d& out, double reach, double part, double height,
                     ColouredShape& shape) {
  // half an ellipsoid: part is the angle from the pole, 1 the outline; below it a flatter half that reaches into the
  // wall, so that a rim that stands off shows no hollow
  const double flat = std::sin(part * M_PI / 2), up = std::cos(part * M_PI / 2);
  if (part > 1) height *= kUnderside;
  const Eigen::Vector3f p = (puddle.centre + reach * flat * out + height * up * puddle.up).cast<float>();
  const Eigen::Vector3f n = (flat / reach * out + up / height * puddle.up).normalized().cast<float>();
  shape.vertices.push_back({{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}});
  shape.colours.push_back(std::abs(part - 1) > 0.01 ? puddle.middle : puddle.rim);
}

/// How far the blood of a wound falls: to the lowest known position of the wall.
double dropBelow(const Wound& wound, const SutureDrawing& scene, const Vector3d& down) {
  double lowest = 0;
  for (const SutureSet& set : scene.sets)
    for (const SutureBite& bite : set.bites) lowest = std::max(lowest, down.dot(bite.place - wound.place));
  const double towards_floor = wound.inward.dot(down);
  if (towards_floor > kSteep) lowest = std::max(lowest, kFromCeiling);
  return std::clamp(lowest, towards_floor < -kSteep ? 0.0 : kMinDrop, kMaxDrop);
}

void appendFlatFilm(const Wound& wound, const BloodStyle& style, ColouredShape& shape) {
  const BloodShade shade = shadeOf(wound);
  Puddle film;
  film.centre = wound.place;
  film.up = wound.inward.norm() > 0.5 ? wound.inward : Vector3d(-style.down);
  film.creep = style.down - style.down.dot(film.up) * film.up;
  film.volume = wound.amount;
  film.max_height = kMaxFilmHeight;
  film.max_radius = kMaxFilmRadius;
  film.number = wound.number;
  film.middle = packedOf(shade);
  film.rim = packedOf(shade, 0.7);
  appendPuddle(film, shape);
}

void appendFlatPool(const Wound& wound, const Vector3d& landing, const BloodStyle& style, ColouredShape& shape) {
  const BloodShade shade = mixed(kBrightBlood, kDarkBlood, 0.75);
  Puddle pool;
  pool.centre = landing;
  pool.up = -style.down;
  pool.creep = Vector3d::Zero();
  pool.volume = wound.amount;
  pool.max_height = kMaxPoolHeight;
  pool.max_radius = kMaxPoolRadius;
  pool.number = wound.number + 100;
  pool.middle = packedOf(wound.rate > 0 ? shade : shadeOf(wound));
  pool.rim = packedOf(wound.rate > 0 ? shade : shadeOf(wound), 0.75);
  appendPuddle(pool, shape);
}

/// Where the jet of a wound lands on the average of a beat.
Vector3d landingOf(const Wound& wound, double duration, const BloodStyle& style) {
  return jetPath(wound, duration, style).back();
}

void appendWound(const Wound& wound, const SutureDrawing& scene, const BloodStyle& style, ColouredShape& shape) {
  if (!wound.brisk) return appendFlatFilm(wound, style, shape);
  const double duration = jetDuration(wound, dropBelow(wound, scene, style.down), style);
  appendFlatPool(wound, landingOf(wound, duration, style), style, shape);
  Wound source = wound;
  source.amount = std::min(wound.amount, 5e-8);  // what clings to the wall around it
  appendFlatFilm(source, style, shape);
  if (wound.rate > 0) appendJet(wound, jetLine(wound, duration, style), style, shape);
}

/// Pools last: they cover the rivulets that run into them.
void appendFlow(const BloodFlow& flow, const WallSurface& wall, const BloodStyle& style, ColouredShape& shape) {
  for (const BloodFilm& film : flow.films) appendFilm(film, wall, style, shape);
  for (const Rivulet& rivulet : flow.rivulets) appendRivulet(rivulet, wall, shape);
  for (const Pool& pool : flow.pools) appendPool(pool, wall, style, shape);
  for (const BloodJet& jet : flow.jets) appendJet(jet.wound, jetLine(jet.wound, jet.duration, style), style, shape);
}

}  // namespace

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

void appendBlood(const SutureDrawing& scene, const BloodStyle& style, const WallSurface* wall, ColouredShape& shape) {
  std::vector<Wound> without_wall = scene.wounds;
  if (wall != nullptr) {
    const BloodFlow flow = flowOf(scene.wounds, *wall, style);
    appendFlow(flow, *wall, style, shape);
    without_wall = flow.elsewhere;
  }
  for (const Wound& wound : without_wall)
    if (wound.amount > 0 || wound.rate > 0) appendWound(wound, scene, style, shape);
}

void BleedingShape::setMesh(const TissueMesh* mesh) {
  mesh_ = mesh;
  wall_.reset();
  changed_ = changed_ || !scene_.wounds.empty();
}

void BleedingShape::setWounds(const SutureDrawing& scene, const BloodStyle& style) {
  changed_ = changed_ || !scene.wounds.empty() || !scene_.wounds.empty();
  scene_ = scene;
  style_ = style;
}

bool BleedingShape::update(const std::vector<MovingVertex>* wall, const Eigen::Isometry3d& pose) {
  if (scene_.wounds.empty() && !changed_) return false;
  const bool on_wall = wall != nullptr && mesh_ != nullptr && !scene_.wounds.empty();
  if (on_wall && !wall_) wall_ = std::make_unique<WallSurface>(mesh_->triangles, mesh_->vertex_count);
  const bool moved = on_wall && wall_->move(*wall, pose);
  if (!changed_ && !moved && on_wall == on_wall_) return false;
  shape_.clear();
  appendBlood(scene_, style_, on_wall ? wall_.get() : nullptr, shape_);
  changed_ = false, on_wall_ = on_wall;
  return true;
}

}  // namespace vibe::graphics
