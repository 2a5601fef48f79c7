#include "geometry/procedural_stomach.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "arithmetic/elementary.hpp"
#include "geometry/ball_union.hpp"
#include "geometry/stomach_knots.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

constexpr double kBlend = 4.5e-3;      // [m]
constexpr double kFlattening = 0.82;   // depth over width of a section
constexpr double kSpacing = 5e-3;      // [m] between balls; small enough that a row has no ripples
constexpr double kCell = 4e-3;         // [m] of the grid for surface extraction
constexpr double kTubeRadius = 11e-3;  // [m] a scope of 6 mm radius passes with clearance for the wall

using Row = std::vector<Eigen::Vector4d>;  // centre and radius [m]

Eigen::Vector4d toMetres(const Knot& k) {
  return 1e-3 * Eigen::Vector4d(k.x, k.y, k.z, k.radius);
}

/// Catmull-Rom curve through the knots, sampled about every kSpacing.
Row sample(const Row& knots) {
  Row row;
  const int last = static_cast<int>(knots.size()) - 1;
  for (int k = 0; k < last; ++k) {
    const Eigen::Vector4d& p1 = knots[k];
    const Eigen::Vector4d& p2 = knots[k + 1];
    const Eigen::Vector4d p0 = k > 0 ? knots[k - 1] : Eigen::Vector4d(2.0 * p1 - p2);
    const Eigen::Vector4d p3 = k + 1 < last ? knots[k + 2] : Eigen::Vector4d(2.0 * p2 - p1);
    const int steps = std::max(1, static_cast<int>(std::lround((p2 - p1).head<3>().norm() / kSpacing)));
    for (int i = 0; i < steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      row.push_back(0.5 * (2.0 * p1 + t * (p2 - p0) + t * t * (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3) +
                           t * t * t * (3.0 * p1 - p0 - 3.0 * p2 + p3)));
    }
  }
  row.push_back(knots.back());
  return row;
}

void addRow(BallUnion& balls, const Row& row) {
  for (const auto& ball : row) balls.add(ball.head<3>(), ball[3], kSpacing);
}

/// The axis of the organ; tubes have the given radius.
Row bodyKnots(const StomachKnots& shape, double tube_radius) {
  Row knots;
  for (const auto& k : shape.body) knots.push_back(toMetres(k));
  knots.push_back(toMetres(shape.pylorus));
  Eigen::Vector4d duodenum = toMetres(shape.duodenum);
  duodenum[3] *= tube_radius / kTubeRadius;
  knots.push_back(duodenum);
  return knots;
}

Row gulletKnots(const StomachKnots& shape, double tube_radius) {
  Row knots{toMetres(shape.gullet), toMetres(shape.junction)};
  for (auto& k : knots) k[3] = tube_radius;
  return knots;
}

Eigen::AlignedBox3d boxAround(const Row& row, double margin) {
  Eigen::AlignedBox3d box;
  for (const auto& ball : row) {
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(ball[3] + margin);
    box.extend(Eigen::Vector3d(ball.head<3>() - reach));
    box.extend(Eigen::Vector3d(ball.head<3>() + reach));
  }
  return box;
}

TubeEnd makeEnd(const Eigen::Vector4d& end, const Eigen::Vector4d& inner) {
  return {end.head<3>(), (end - inner).head<3>().normalized(), end[3]};
}

Eigen::Vector3d highest(const SurfaceMesh& surface, const Eigen::Vector3d& near, double reach) {
  Eigen::Vector3d best(0, 0, -1e9);
  for (const auto& v : surface.vertices) {
    if ((v - near).norm() < reach && v.z() > best.z()) best = v;
  }
  return best;
}

void scale(StomachShape& shape, double factor) {
  for (auto& v : shape.surface.vertices) v *= factor;
  Landmarks& l = shape.landmarks;
  for (Eigen::Vector3d* p :
       {&l.oesophagus, &l.fundus, &l.incisura, &l.pylorus, &shape.oesophagus.centre, &shape.duodenum.centre}) {
    *p *= factor;
  }
  shape.oesophagus.radius *= factor;
  shape.duodenum.radius *= factor;
}

}  // namespace

StomachShape makeStomachShape(double volume, const StomachKnots& given) {
  if (!(volume >= 0.15e-3 && volume <= 4e-3)) {
    throw Error("geometry.volume, times the cube of geometry.scale, is " + std::to_string(volume * 1e3) +
                " litres; a stomach can be made with 0.15 to 4 litres (0.15e-3 to 4e-3 m^3)");
  }
  const double tube_radius = kTubeRadius * math::cbrt(given.volume / volume);
  const Row knots = bodyKnots(given, tube_radius);
  const Row body = sample(knots), gullet = sample(gulletKnots(given, tube_radius));
  const auto balls = std::make_shared<BallUnion>(kBlend, kFlattening);
  addRow(*balls, body);
  addRow(*balls, gullet);

  StomachShape shape;
  Eigen::AlignedBox3d box = boxAround(body, 2.0 * kBlend);
  box.extend(boxAround(gullet, 2.0 * kBlend));
  shape.surface = marchTetrahedra([&](const Eigen::Vector3d& p) { return balls->value(p); }, box, kCell);
  for (auto& v : shape.surface.vertices) v = balls->project(v);
  shape.landmarks.oesophagus = toMetres(given.junction).head<3>();
  shape.landmarks.fundus = highest(shape.surface, body.front().head<3>(), 1.3 * body.front()[3]);
  shape.landmarks.incisura = balls->project(toMetres(given.incisura_side).head<3>());
  shape.landmarks.pylorus = toMetres(given.pylorus).head<3>();
  // the outermost ball has no outer neighbour and is smaller there: the rim is at the next one
  shape.oesophagus = makeEnd(gullet[1], gullet[2]);
  shape.duodenum = makeEnd(body[body.size() - 2], body[body.size() - 3]);

  const double factor = math::cbrt(volume / enclosedVolume(shape.surface));
  scale(shape, factor);
  shape.project = [balls, factor](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    return factor * balls->project(p / factor);
  };
  return shape;
}

}  // namespace vibe
