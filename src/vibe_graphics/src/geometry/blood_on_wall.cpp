#include "geometry/blood_on_wall.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "vibe_graphics/geometry/blood_colour.hpp"
#include "vibe_graphics/geometry/coloured_shape.hpp"
#include "vibe_graphics/geometry/tube.hpp"

namespace vibe::graphics {
namespace {

using Eigen::Vector3d;

constexpr double kRaised = 0.08e-3;                        // the edge of blood over the wall [m]
constexpr double kRimDepth = 0.05e-3;                      // depth of blood at its edge [m]
constexpr double kFilmHeight = 0.6e-3, kFilmSlope = 0.25;  // [m]; of a small drop, height to radius
constexpr double kMaxDrawnRadius = 9e-3;                   // beyond, blood is not drawn [m]
constexpr int kFilmSides = 22, kFilmRings = 4;             // of a film
constexpr double kFade = 6e-3;                             // a rivulet reaches its width on this way [m]
constexpr std::array<double, 7> kAcross{-1, -0.8, -0.45, 0, 0.45, 0.8, 1};  // of the half-width
constexpr std::uint32_t kPoints = kAcross.size();
constexpr double kShore = 0.4e-3, kShoreTilt = 0.7;  // depth at which normals tilt at the shore [m]

void addVertex(const Vector3d& place, const Vector3d& normal, const BloodShade& shade, ColouredShape& shape) {
  const Eigen::Vector3f p = place.cast<float>(), n = normal.normalized().cast<float>();
  shape.vertices.push_back({{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}});
  shape.colours.push_back(packedOf(shade));
}

Vector3d alongWall(const Vector3d& v, const WallPlace& at) {
  return v - v.dot(at.inward) * at.inward;
}

/// Downhill on the wall; where it is level, along its triangle, so that the direction moves with the wall.
Vector3d downhill(const WallPlace& at, const WallSurface& wall, const Vector3d& down) {
  const Vector3d slope = alongWall(down, at);
  if (slope.norm() > 1e-3) return slope.normalized();
  const std::uint32_t* corner = wall.corners(at.triangle);
  const Vector3d edge = alongWall(wall.places()[corner[1]] - wall.places()[corner[0]], at);
  return edge.norm() > 1e-9 ? Vector3d(edge.normalized()) : anyNormal(at.inward);
}

double filmRadius(double volume) {
  const double small = std::cbrt(2 * volume / (M_PI * kFilmSlope)), flat = std::sqrt(2 * volume / (M_PI * kFilmHeight));
  return std::min(kMaxDrawnRadius, std::max(small, flat));
}

double filmReach(const BloodFilm& film, double angle) {
  double reach = 1 + 0.15 * std::max(0.0, std::cos(angle));
  for (int k = 0; k < 3; ++k)
    reach += 0.06 * wobble(film.number, k) * std::cos((k + 2) * angle + M_PI * wobble(film.number, k + 3));
  return reach;
}

/// Offset of the middle of a rivulet, and factor of its width, at a distance from its start.
double bend(const Rivulet& rivulet, double s) {
  const double a = M_PI * wobble(rivulet.number, 11), b = M_PI * wobble(rivulet.number, 12);
  return std::min(1.0, s / kFade) * (0.5e-3 * std::sin(s / 4.3e-3 + a) + 0.3e-3 * std::sin(s / 1.9e-3 + b));
}

double widthAt(const Rivulet& rivulet, double s) {
  const double c = M_PI * wobble(rivulet.number, 13);
  const double wide = (0.6 + 0.4 * std::min(1.0, s / kFade)) *
                      (1 + 0.18 * std::sin(s / 1.7e-3 + c) + 0.12 * std::sin(s / 3.1e-3 + 2 * c));
  const double head = 0.6 * rivulet.width, left = rivulet.length - s;  // the head is round
  if (left >= head) return wide;
  const double part = 1 - std::max(0.0, left) / head;
  return wide * std::sqrt(std::max(0.0, 1 - part * part));
}

/// Slope of the surface along a rivulet, which breaks its highlight.
double rippleAt(const Rivulet& rivulet, double s) {
  const double d = M_PI * wobble(rivulet.number, 14);
  return 0.2 * std::sin(s / 0.9e-3 + d) + 0.15 * std::sin(s / 1.47e-3 + 2 * d) + 0.15 * std::sin(s / 2.9e-3 + 3 * d);
}

void addRow(const Rivulet& rivulet, const WallPlace& at, const Vector3d& along, double s, const WallSurface& wall,
            ColouredShape& shape) {
  const Vector3d across = at.inward.cross(along).normalized();
  const double half = std::max(0.5 * rivulet.width * widthAt(rivulet, s), 1e-5), middle = bend(rivulet, s);
  const double ripple = rippleAt(rivulet, s);
  for (const double u : kAcross) {
    const WallPlace under = wall.moved(at, (middle + half * u) * across);
    const double depth = rivulet.thickness * (1 - u * u) * std::min(1.0, half / (0.4 * rivulet.width));
    const Vector3d normal = under.inward + 2 * u * rivulet.thickness / half * across + ripple * along.normalized();
    addVertex(under.place + (kRaised + depth) * under.inward, normal, layerOf(kRimDepth + depth, rivulet.brown), shape);
  }
}

/// Corner of the surface of a pool.
struct PoolCorner {
  Vector3d place;   // on the wall [m]
  Vector3d inward;  // of the wall
  double depth;     // [m]
};

PoolCorner between(const PoolCorner& a, const PoolCorner& b) {
  const double t = a.depth / (a.depth - b.depth);
  return {a.place + t * (b.place - a.place), a.inward + t * (b.inward - a.inward), 0};
}

/// The part of a triangle that is below the level: 0, 3 or 4 corners (Sutherland, Hodgman 1974).
std::vector<PoolCorner> belowLevel(const std::array<PoolCorner, 3>& corners) {
  std::vector<PoolCorner> part;
  part.reserve(4);
  for (std::size_t k = 0; k < 3; ++k) {
    const PoolCorner &here = corners[k], &next = corners[(k + 1) % 3];
    if (here.depth >= 0) part.push_back(here);
    if ((here.depth > 0 && next.depth < 0) || (here.depth < 0 && next.depth > 0)) part.push_back(between(here, next));
  }
  return part;
}

void addPoolCorner(const PoolCorner& corner, double brown, const Vector3d& down, ColouredShape& shape) {
  const Vector3d outside = -(corner.inward - corner.inward.dot(down) * down);  // uphill, to the shore
  const double tilt = kShoreTilt * std::exp(-corner.depth / kShore);
  const Vector3d normal = -down + (outside.norm() > 1e-3 ? Vector3d(tilt * outside.normalized()) : Vector3d::Zero());
  addVertex(corner.place - corner.depth * down, normal, layerOf(kRimDepth + corner.depth, brown), shape);
}

}  // namespace

void appendFilm(const BloodFilm& film, const WallSurface& wall, const BloodStyle& style, ColouredShape& shape) {
  const double radius = filmRadius(film.volume), height = 2 * film.volume / (M_PI * radius * radius);
  const Vector3d first = downhill(film.at, wall, style.down), second = film.at.inward.cross(first);
  const auto base = static_cast<std::uint32_t>(shape.vertices.size());
  std::vector<WallPlace> at(kFilmSides, film.at);
  for (int ring = 0; ring <= kFilmRings; ++ring) {
    const double part = static_cast<double>(ring) / kFilmRings,
                 depth = std::min(height, kFilmHeight) * (1 - part * part);
    for (int k = 0; k < kFilmSides; ++k) {
      const double angle = 2 * M_PI * k / kFilmSides, reach = radius * filmReach(film, angle);
      const Vector3d out = std::cos(angle) * first + std::sin(angle) * second;
      if (ring > 0)
        at[static_cast<std::size_t>(k)] = wall.moved(at[static_cast<std::size_t>(k)], reach / kFilmRings * out);
      const WallPlace& under = at[static_cast<std::size_t>(k)];
      addVertex(under.place + (kRaised + depth) * under.inward,
                under.inward + 2 * part * std::min(height, kFilmHeight) / reach * out,
                layerOf(kRimDepth + depth, film.brown), shape);
    }
    const auto row = static_cast<std::uint32_t>(base + ring * kFilmSides);
    if (ring > 0) joinRows(row - kFilmSides, row, kFilmSides, true, shape);
  }
}

void appendRivulet(const Rivulet& rivulet, const WallSurface& wall, ColouredShape& shape) {
  if (rivulet.line.size() < 2) return;
  double s = 0;
  for (std::size_t k = 0; k < rivulet.line.size(); ++k) {
    const std::size_t before = k > 0 ? k - 1 : 0, after = std::min(k + 1, rivulet.line.size() - 1);
    if (k > 0) s += (rivulet.line[k].place - rivulet.line[k - 1].place).norm();
    const WallPlace& at = rivulet.line[k];
    const Vector3d along = alongWall(rivulet.line[after].place - rivulet.line[before].place, at);
    const auto row = static_cast<std::uint32_t>(shape.vertices.size());
    addRow(rivulet, at, along.norm() > 1e-9 ? along : anyNormal(at.inward), s, wall, shape);
    if (k > 0) joinRows(row - kPoints, row, kPoints, false, shape);
  }
}

void appendPool(const Pool& pool, const WallSurface& wall, const BloodStyle& style, ColouredShape& shape) {
  for (const std::uint32_t t : pool.triangles) {
    std::array<PoolCorner, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = wall.corners(t)[k];
      const Vector3d& place = wall.places()[vertex];
      corners[k] = {place, wall.inwards()[vertex], pool.level + place.dot(style.down)};
    }
    const Vector3d outward = (corners[1].place - corners[0].place).cross(corners[2].place - corners[0].place);
    if (!(outward.dot(style.down) > 0)) continue;  // overhangs the pool, which is drawn below already
    const std::vector<PoolCorner> part = belowLevel(corners);
    const auto base = static_cast<std::uint32_t>(shape.vertices.size());
    for (const PoolCorner& corner : part) addPoolCorner(corner, pool.brown, style.down, shape);
    for (std::uint32_t k = 2; k < part.size(); ++k)  // seen from above, not from outside
      shape.triangles.insert(shape.triangles.end(), {base, base + k, base + k - 1});
  }
}

}  // namespace vibe::graphics
