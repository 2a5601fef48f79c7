#include "vibe_core/thermal/argon_beam.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "arithmetic/elementary.hpp"
#include "geometry/ray.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

void expect(const char* key, double value, double low, double high, const char* unit) {
  if (value >= low && value <= high) return;
  throw Error(
      formatted("marking.%s: %g is not from %g to %g %s; give a value in that range.", key, value, low, high, unit));
}

}  // namespace

void ApcParameters::check() const {
  expect("power", power, 0, 200, "W");
  expect("efficiency", efficiency, 0, 1, "");
  expect("argon_flow", argon_flow, 0, 10 * kLitrePerMinute, "m^3/s");
  expect("probe_length", probe_length, 0, 0.1, "m");
  expect("reach", reach, 0, 0.05, "m");
  expect("spot_radius", spot_radius, 0.0005, 0.02, "m");
  expect("spread", spread, 0, 1, "rad");
  expect("mark_energy", mark_energy, 1e-3, 1e5, "J");
  expect("burn_energy", burn_energy, mark_energy, 1e5, "J");
  expect("deep_energy", deep_energy, burn_energy, 1e5, "J");
  expect("tissue_cooling", tissue_cooling, 0, 10, "1/s");
  expect("argon_cooling", argon_cooling, 0, 10, "1/s");
  expect("insufflation_cooling", insufflation_cooling, 0, 10, "1/s");
}

namespace {

constexpr double kRim = 1.75;  // in radii; beyond, the power per area is below 0.9 % of the maximum
constexpr double kMeshCarries =
    0.6;  // radius over longest edge: the centroid of a triangle lies 0.58 edges from its corners

double footprint(double distance, double radius) {
  const double s = distance / radius;
  return math::exp(-0.5 * s * s * s * s);
}

double longestSide(const SurfaceView& wall, const std::array<int, 3>& t) {
  const Eigen::Vector3d a = wall.position(t[0]), b = wall.position(t[1]), c = wall.position(t[2]);
  return std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
}

}  // namespace

ArgonBeam::ArgonBeam(const SurfaceMesh& surface)
    : neighbours_(vertexNeighbours(surface)),
      triangles_of_(surface.vertices.size()),
      seen_(surface.vertices.size(), 0) {
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (const int v : surface.triangles[t]) triangles_of_[v].push_back(static_cast<int>(t));
  patch_.reserve(surface.vertices.size());
  shares_.reserve(surface.vertices.size());
}

const BeamHit& ArgonBeam::fire(const Eigen::Vector3d& tip, const Eigen::Vector3d& direction, const SurfaceView& wall,
                               double half_wall, const ApcParameters& parameters) {
  hit_ = BeamHit{};
  shares_.clear();
  const double norm = direction.norm();
  if (!tip.allFinite() || !std::isfinite(norm) || norm <= 0) return hit_;
  // a tip pressed into the wall may be beyond its mid-surface, so the ray starts behind the tip, where there is only
  // the scope
  const Eigen::Vector3d unit = direction / norm;
  const double probe_end = half_wall + parameters.probe_length;
  const Ray ray(tip - half_wall * unit, unit, probe_end + parameters.reach + half_wall);
  const RayHit met = firstHit(ray, wall);
  if (met.triangle < 0) return hit_;
  hit_.triangle = met.triangle;
  hit_.point = ray.at(met.distance);
  hit_.gap = std::max(0.0, met.distance - half_wall - probe_end);
  spreadOver(ray, wall, parameters);
  return hit_;
}

double ArgonBeam::areaFacing(int particle, const Ray& ray, const SurfaceView& wall) const {
  const double side = areaVector(wall, wall.triangles[hit_.triangle]).dot(ray.direction) < 0 ? -1 : 1;
  double area = 0;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (const int t : triangles_of_[particle]) {
    const Eigen::Vector3d twice = areaVector(wall, wall.triangles[t]);
    area += twice.norm() / 6;
    normal += twice;
  }
  return side * normal.dot(ray.direction) > 0 ? area : 0;
}

/// Particles under the footprint: reached from the hit triangle along edges, within the footprint and facing the probe.
void ArgonBeam::collect(const Ray& ray, const SurfaceView& wall) {
  patch_.clear();
  const auto visit = [&](int particle) {
    if (seen_[particle] != 0) return;
    const double distance = (wall.position(particle) - hit_.point).norm();
    if (!(distance <= kRim * hit_.radius)) return;
    const double area = areaFacing(particle, ray, wall);
    if (!(area > 0)) return;
    seen_[particle] = 1;
    patch_.push_back(particle);
    const double cover = footprint(distance, hit_.radius);
    shares_.push_back({particle, area * cover, 0, cover});
  };
  for (const int corner : wall.triangles[hit_.triangle]) visit(corner);
  for (std::size_t i = 0; i < patch_.size(); ++i)
    for (const int next : neighbours_[patch_[i]]) visit(next);
  for (const int particle : patch_) seen_[particle] = 0;
}

void ArgonBeam::spreadOver(const Ray& ray, const SurfaceView& wall, const ApcParameters& parameters) {
  const double radius = parameters.spot_radius + hit_.gap * math::tan(parameters.spread);
  const double dilution = (parameters.spot_radius / radius) * (parameters.spot_radius / radius);
  hit_.radius = std::max(radius, kMeshCarries * longestSide(wall, wall.triangles[hit_.triangle]));
  collect(ray, wall);
  double sum = 0;
  for (const BeamShare& share : shares_) sum += share.power;
  if (!(sum > 0)) {
    // at the very edge of a fold all corners may face away: the beam passes by
    shares_.clear();
    hit_ = BeamHit{};
    return;
  }
  const double absorbed = parameters.power * parameters.efficiency;
  for (BeamShare& share : shares_) {
    share.power *= absorbed / sum;
    share.spot_power = absorbed * dilution * share.cover;
  }
}

}  // namespace vibe
