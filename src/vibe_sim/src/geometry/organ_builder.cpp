#include "vibe_sim/geometry/organ_builder.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "vibe_sim/error.hpp"
#include "vibe_sim/geometry/procedural_stomach.hpp"
#include "vibe_sim/geometry/regions.hpp"
#include "vibe_sim/geometry/remesh.hpp"
#include "vibe_sim/geometry/smoothing.hpp"

namespace vibe {

namespace {

constexpr int kFewestParticles = 100;
constexpr int kMostParticles = 200000;

void checkParticles(int particles) {
  if (particles < kFewestParticles || particles > kMostParticles) {
    throw Error("geometry.particles is " + std::to_string(particles) + "; choose " + std::to_string(kFewestParticles) +
                " to " + std::to_string(kMostParticles));
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

/// Applies p -> factor * p + shift to everything in the organ that has a place.
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
  const StomachShape shape = makeStomachShape(scene.geometry.volume);
  Organ organ;
  organ.surface = remesh(shape.surface, scene.geometry.particles, shape.project, progress);
  organ.landmarks = shape.landmarks;
  organ.end.assign(organ.surface.vertices.size(), End::None);
  markDome(organ, shape.oesophagus, End::Oesophagus);
  markDome(organ, shape.duodenum, End::Duodenum);
  organ.entry = shape.oesophagus.centre;
  organ.entry_axis = -shape.oesophagus.outward;
  transform(organ, std::cbrt(scene.geometry.volume / enclosedVolume(organ.surface)), Eigen::Vector3d::Zero());
  transform(organ, 1.0, -centroid(organ.surface));
  labelStomach(organ);
  return organ;
}

}  // namespace

Organ buildOrgan(const Scene& scene, const Progress& progress) {
  checkParticles(scene.geometry.particles);
  Organ organ = buildStomach(scene, progress);
  organ.thickness = thicknessFromRegions(organ.surface, organ.region, scene.tissue.thickness);
  return organ;
}

}  // namespace vibe
