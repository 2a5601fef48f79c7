#include "vibe_core/builder/model_builder.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>

#include "arithmetic/elementary.hpp"
#include "arithmetic/turn.hpp"
#include "builder/mesh_import.hpp"
#include "geometry/procedural_stomach.hpp"
#include "geometry/regions.hpp"
#include "geometry/remesh.hpp"
#include "geometry/stomach_knots.hpp"
#include "geometry/surface_check.hpp"
#include "vibe_core/geometry/triangle_tree.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

constexpr int kFewestParticles = 100;
constexpr int kMaxParticles = 200000;
constexpr double kOesophagusRadius = 10e-3;  // [m] of the held patch of an imported surface
constexpr double kPylorusRadius = 9e-3;      // [m]
constexpr double kScopeRadius = 6e-3;        // [m]
constexpr int kScopeRays = 8;                // along the surface of the scope
constexpr int kDirections = 2000;            // that are tried for the scope

void checkParticles(int particles) {
  if (particles < kFewestParticles || particles > kMaxParticles) {
    throw Error("geometry.particles is " + std::to_string(particles) + "; choose " + std::to_string(kFewestParticles) +
                " to " + std::to_string(kMaxParticles));
  }
}

Eigen::Vector3d centroid(const SurfaceMesh& mesh) {
  // of the enclosed volume, as a sum of tetrahedra with the first vertex
  const Eigen::Vector3d& o = mesh.vertices.front();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double volume = 0.0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]] - o, b = mesh.vertices[t[1]] - o, c = mesh.vertices[t[2]] - o;
    const double part = a.dot(b.cross(c));
    sum += part * (a + b + c) / 4.0;
    volume += part;
  }
  return o + sum / volume;
}

/// Applies p -> factor * p + shift to all positions in the organ.
void transform(Organ& organ, double factor, const Eigen::Vector3d& shift) {
  Landmarks& l = organ.landmarks;
  for (Eigen::Vector3d* p : {&l.oesophagus, &l.fundus, &l.incisura, &l.pylorus, &organ.entry}) *p = factor * *p + shift;
  for (auto& v : organ.surface.vertices) v = factor * v + shift;
}

/// Marks the dome beyond the rim of a tube; the nearest vertex if the mesh is too coarse for the dome.
void markDome(Organ& organ, const TubeEnd& tube, End end) {
  const Eigen::Vector3d tip = tube.centre + tube.radius * tube.outward;
  int nearest = 0;
  for (int v = 0; v < static_cast<int>(organ.surface.vertices.size()); ++v) {
    const Eigen::Vector3d& x = organ.surface.vertices[v];
    const Eigen::Vector3d out = x - tube.centre;
    if (out.dot(tube.outward) >= 0.0 && out.norm() < 1.5 * tube.radius) organ.end[v] = end;
    if ((x - tip).norm() < (organ.surface.vertices[nearest] - tip).norm()) nearest = v;
  }
  organ.end[nearest] = end;
}

Organ buildStomach(const Scene& scene, const Progress& progress) {
  const double volume = scene.geometry.volume * scene.geometry.scale * scene.geometry.scale * scene.geometry.scale;
  const StomachShape shape = makeStomachShape(
      volume, variedKnots(scene.geometry.shape, scene.geometry.fundus_width, scene.geometry.antrum_angle));
  Organ organ;
  organ.surface = remesh(shape.surface, scene.geometry.particles, shape.project, progress);
  organ.landmarks = shape.landmarks;
  organ.end.assign(organ.surface.vertices.size(), End::None);
  markDome(organ, shape.oesophagus, End::Oesophagus);
  markDome(organ, shape.duodenum, End::Duodenum);
  organ.entry = shape.oesophagus.centre;
  organ.entry_axis = -shape.oesophagus.outward;
  transform(organ, math::cbrt(volume / enclosedVolume(organ.surface)), Eigen::Vector3d::Zero());
  transform(organ, 1.0, -centroid(organ.surface));
  labelStomach(organ);
  return organ;
}

/// Marks the vertices around a point of the surface, or the nearest one.
void markPatch(Organ& organ, const Eigen::Vector3d& point, double radius, End end) {
  int nearest = 0;
  for (int v = 0; v < static_cast<int>(organ.surface.vertices.size()); ++v) {
    const double distance = (organ.surface.vertices[v] - point).norm();
    if (distance <= radius) organ.end[v] = end;
    if (distance < (organ.surface.vertices[nearest] - point).norm()) nearest = v;
  }
  organ.end[nearest] = end;
}

/// How far a scope can move from `start` along `direction` before its surface touches the wall [m].
double clearLength(const TriangleTree& tree, const Eigen::Vector3d& start, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d side = direction.unitOrthogonal();
  double clear = tree.firstHit(start, direction);
  for (int k = 0; k < kScopeRays; ++k) {
    const Eigen::Vector3d offset = rotationAbout(direction, 2.0 * M_PI * k / kScopeRays) * side * kScopeRadius;
    clear = std::min(clear, tree.firstHit(start + offset, direction));
  }
  return clear;
}

/// The direction in which a straight scope can move farthest from a hole in the wall.
Eigen::Vector3d longestWayIn(const SurfaceMesh& mesh, const Eigen::Vector3d& entry) {
  const TriangleTree tree(mesh);
  const auto& wall = mesh.triangles[tree.closest(entry).triangle];
  const Eigen::Vector3d& corner = mesh.vertices[wall[0]];
  const Eigen::Vector3d inward = -(mesh.vertices[wall[1]] - corner).cross(mesh.vertices[wall[2]] - corner).normalized();
  Eigen::Vector3d best = inward;
  double best_length = 0.0;
  for (int k = 0; k < kDirections; ++k) {
    // Fibonacci lattice on the sphere
    const double z = 1.0 - (2.0 * k + 1.0) / kDirections, angle = k * M_PI * (3.0 - std::sqrt(5.0));
    const double r = std::sqrt(1.0 - z * z);
    const Eigen::Vector3d direction(r * math::cos(angle), r * math::sin(angle), z);
    if (direction.dot(inward) < 0.5) continue;  // within 60 degrees of straight in
    const double length = clearLength(tree, entry + kScopeRadius * 1.5 * inward, direction);
    if (length > best_length && length < std::numeric_limits<double>::infinity()) {
      best_length = length;
      best = direction;
    }
  }
  return best;
}

Organ buildImported(const Scene& scene, const Progress& progress) {
  GeometryScene geometry = scene.geometry;
  const std::filesystem::path file(geometry.file);
  if (!geometry.file.empty() && file.is_relative() && !scene.file.empty()) {
    geometry.file = (std::filesystem::path(scene.file).parent_path() / file).string();
  }
  if (progress) progress("reading " + geometry.file, 0.0);
  const ImportedMesh imported = importMesh(geometry);
  Organ organ;
  organ.surface = remeshSurface(imported.surface, geometry.particles, nullptr, progress);
  checkSurface(organ.surface, geometry.file + " with " + std::to_string(geometry.particles) + " particles");
  organ.landmarks = imported.landmarks;
  const TriangleTree tree(organ.surface);
  organ.entry = tree.closest(organ.landmarks.oesophagus).point;
  organ.entry_axis = longestWayIn(organ.surface, organ.entry);
  organ.end.assign(organ.surface.vertices.size(), End::None);
  markPatch(organ, organ.entry, kOesophagusRadius, End::Oesophagus);
  markPatch(organ, tree.closest(organ.landmarks.pylorus).point, kPylorusRadius, End::Duodenum);
  transform(organ, 1.0, -centroid(organ.surface));
  try {
    labelStomach(organ);
  } catch (const Error& error) {
    throw Error(geometry.file + ": " + error.what());
  }
  return organ;
}

/// Icosahedron on the unit sphere.
SurfaceMesh icosahedron() {
  const double g = (1.0 + std::sqrt(5.0)) / 2.0;
  SurfaceMesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  for (auto& v : mesh.vertices) v.normalize();
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  return mesh;
}

Organ buildSphere(const Scene& scene, const Progress& progress) {
  const double radius = scene.geometry.radius * scene.geometry.scale;
  if (!(radius >= 1e-3 && radius <= 1.0)) {
    throw Error("geometry.radius, times geometry.scale, is " + std::to_string(radius) + " m; choose 0.001 to 1");
  }
  Organ organ;
  organ.surface = remesh(
      icosahedron(), scene.geometry.particles, [](const Eigen::Vector3d& p) { return p.normalized(); }, progress);
  transform(organ, radius, Eigen::Vector3d::Zero());
  const std::size_t count = organ.surface.vertices.size();
  organ.region.assign(count, Region::Body);
  organ.end.assign(count, End::None);
  for (const auto& v : organ.surface.vertices) organ.wall.push_back(wallAtAngle(math::atan2(v.y(), v.x())));
  organ.landmarks.oesophagus = organ.landmarks.fundus = radius * Eigen::Vector3d::UnitZ();
  organ.landmarks.pylorus = -radius * Eigen::Vector3d::UnitZ();
  organ.landmarks.incisura = -radius * Eigen::Vector3d::UnitY();
  organ.entry = radius * Eigen::Vector3d::UnitZ();
  organ.entry_axis = -Eigen::Vector3d::UnitZ();
  return organ;
}

Organ buildShape(const Scene& scene, const Progress& progress) {
  switch (scene.geometry.kind) {
    case GeometryScene::Kind::Stomach:
      return buildStomach(scene, progress);
    case GeometryScene::Kind::Mesh:
      return buildImported(scene, progress);
    case GeometryScene::Kind::Sphere:
      return buildSphere(scene, progress);
  }
  throw Error("geometry.kind is unknown; choose stomach, mesh or sphere");
}

}  // namespace

Organ buildOrgan(const Scene& scene, const Progress& progress) {
  checkParticles(scene.geometry.particles);
  Organ organ = buildShape(scene, progress);
  organ.thickness = thicknessFromRegions(organ.surface, organ.region, scene.tissue.thickness);
  return organ;
}

}  // namespace vibe
