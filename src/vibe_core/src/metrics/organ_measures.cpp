#include "vibe_core/metrics/organ_measures.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/regions.hpp"
#include "geometry/surface_operators.hpp"
#include "vibe_core/geometry/triangle_tree.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {
namespace {

constexpr int kMaxRings = 32;
constexpr int kVerticesPerRing = 16;  // at least, on average
constexpr double kNear = 0.15;        // of the axis: a loop whose wall is farther from the section belongs elsewhere
constexpr int kSmoothings = 18;       // of the directions to the greater curvature: a standard deviation of 3 stations

using Values = std::vector<double>;

Eigen::Vector3d at(const Values& x, const Values& y, const Values& z, int v) {
  return {x[v], y[v], z[v]};
}

int nearest(const SurfaceMesh& mesh, const Eigen::Vector3d& point) {
  const auto less = [&](const auto& a, const auto& b) { return (a - point).norm() < (b - point).norm(); };
  return static_cast<int>(std::min_element(mesh.vertices.begin(), mesh.vertices.end(), less) - mesh.vertices.begin());
}

/// The wall of the oesophagus, which is no part of any ring.
std::vector<bool> gullet(const Organ& organ) {
  std::vector<int> seeds;
  for (int v = 0; v < static_cast<int>(organ.end.size()); ++v)
    if (organ.end[v] == End::Oesophagus) seeds.push_back(v);
  const double length = (organ.entry - organ.landmarks.oesophagus).norm();
  std::vector<bool> inside;
  for (double distance : edgeDistances(organ.surface, seeds)) inside.push_back(distance < length);
  return inside;
}

/// The middles of the rings of an irregular mesh jitter, and the directions square to the line through them with them:
/// the points they reach on the wall would run to and fro, which adds a quarter to the length of the curve.
std::vector<Eigen::Vector3d> smoothDirections(const std::vector<StomachAxis::Station>& stations) {
  std::vector<Eigen::Vector3d> directions;
  for (const auto& station : stations) directions.push_back(station.greater);
  for (int round = 0; round < kSmoothings; ++round) {
    const std::vector<Eigen::Vector3d> old = directions;
    for (std::size_t s = 1; s + 1 < old.size(); ++s)
      directions[s] = (old[s - 1] + 2 * old[s] + old[s + 1]).normalized();
  }
  return directions;
}

/// The vertex of the duodenal end that is farthest out.
int outletOf(const Organ& organ, const StomachAxis& axis) {
  const Eigen::Vector3d& out = axis.stations().back().tangent;
  int best = -1;
  for (int v = 0; v < static_cast<int>(organ.end.size()); ++v) {
    if (organ.end[v] != End::Duodenum) continue;
    if (best < 0 || organ.surface.vertices[v].dot(out) > organ.surface.vertices[best].dot(out)) best = v;
  }
  return best;
}

}  // namespace

OrganRuler::OrganRuler(const Organ& organ) : surface_(organ.surface), section_(organ.surface) {
  const Eigen::Vector3d line = organ.landmarks.pylorus - organ.landmarks.fundus;
  const bool has_end = std::find(organ.end.begin(), organ.end.end(), End::Duodenum) != organ.end.end();
  has_axis_ = has_end || line.norm() > 0;
  if (!has_axis_) return;
  if (has_end) {
    const StomachAxis axis = findAxis(organ);
    Values coordinate;
    for (int v = 0; v < static_cast<int>(organ.end.size()); ++v) coordinate.push_back(axis.lengthAt(v));
    apex_ = nearest(surface_, organ.landmarks.fundus);
    outlet_ = outletOf(organ, axis);
    findRings(organ, coordinate, gullet(organ));
    findCurvature(organ, axis.stations());
  } else {
    const Eigen::Vector3d direction = line.normalized();
    Values coordinate;
    for (const auto& p : surface_.vertices) coordinate.push_back(p.dot(direction));
    apex_ = nearest(surface_, organ.landmarks.fundus);
    outlet_ = nearest(surface_, organ.landmarks.pylorus);
    findRings(organ, coordinate, std::vector<bool>(coordinate.size(), false));
    findCurvature(organ, straightStations(organ, direction));
  }
}

void OrganRuler::findRings(const Organ& organ, const Values& coordinate, const std::vector<bool>& ignored) {
  const auto [low, high] = std::minmax_element(coordinate.begin(), coordinate.end());
  const Values area = vertexAreas(surface_);
  const int rings = std::clamp(static_cast<int>(coordinate.size()) / kVerticesPerRing, 4, kMaxRings);
  Values body(rings, 0.0);
  ring_weight_.assign(rings, 0.0);
  axis_.resize(rings + 2);
  for (std::size_t v = 0; v < coordinate.size(); ++v) {
    const double place = (coordinate[v] - *low) / (*high - *low) * (rings - 1);
    Share share;
    share.ring = std::clamp(static_cast<int>(place), 0, rings - 2);
    share.part = 1 - (place - share.ring);
    share.weight = ignored[v] ? 0 : area[v];
    share_.push_back(share);
    label_.push_back(ignored[v] ? std::numeric_limits<double>::quiet_NaN() : place);
    for (int k = 0; k < 2; ++k) {
      const double weight = share.weight * (k == 0 ? share.part : 1 - share.part);
      ring_weight_[share.ring + k] += weight;
      if (organ.region[v] == Region::Body) body[share.ring + k] += weight;
    }
  }
  if (!(*std::min_element(ring_weight_.begin(), ring_weight_.end()) > 0))
    throw Error(
        "The organ's wall has a gap along its axis, so its cross-sections cannot be found; mesh it more evenly.");
  for (int r = 0; r < rings; ++r) in_body_.push_back(body[r] > 0.5 * ring_weight_[r]);
}

std::vector<StomachAxis::Station> OrganRuler::straightStations(const Organ& organ, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d& front = organ.landmarks.anterior;
  Eigen::Vector3d across = front.cross(direction);
  if (across.norm() < 1e-6) across = direction.unitOrthogonal();
  Values x, y, z;
  for (const auto& p : surface_.vertices) {
    x.push_back(p.x());
    y.push_back(p.y());
    z.push_back(p.z());
  }
  placeRings(x, y, z);
  std::vector<StomachAxis::Station> stations(ring_weight_.size());
  for (std::size_t r = 0; r < stations.size(); ++r) {
    stations[r].centre = axis_[r + 1];
    stations[r].greater = across.normalized();
  }
  return stations;
}

void OrganRuler::findCurvature(const Organ& organ, const std::vector<StomachAxis::Station>& stations) {
  const TriangleTree tree(organ.surface);
  const std::vector<Eigen::Vector3d> greater = smoothDirections(stations);
  for (std::size_t s = 0; s < stations.size(); ++s) {
    const double out = tree.firstHit(stations[s].centre, greater[s]);
    if (!std::isfinite(out)) continue;  // the middle of a ring in a sharp bend may lie outside
    const auto hit = tree.closest(stations[s].centre + out * greater[s]);
    WallPoint point;
    point.corner = surface_.triangles[hit.triangle];
    const Eigen::Vector3d &a = surface_.vertices[point.corner[0]], &b = surface_.vertices[point.corner[1]],
                          &c = surface_.vertices[point.corner[2]];
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    const double v = normal.dot((hit.point - a).cross(c - a)) / normal.squaredNorm();
    const double w = normal.dot((b - a).cross(hit.point - a)) / normal.squaredNorm();
    point.weight = Eigen::Vector3d(1 - v - w, v, w);
    curvature_.push_back(point);
  }
}

void OrganRuler::placeRings(const Values& x, const Values& y, const Values& z) {
  std::fill(axis_.begin(), axis_.end(), Eigen::Vector3d::Zero());
  for (std::size_t v = 0; v < share_.size(); ++v) {
    const Share& share = share_[v];
    const Eigen::Vector3d p = share.weight * at(x, y, z, static_cast<int>(v));
    axis_[share.ring + 1] += share.part * p;
    axis_[share.ring + 2] += (1 - share.part) * p;
  }
  for (std::size_t r = 0; r < ring_weight_.size(); ++r) axis_[r + 1] /= ring_weight_[r];
  axis_.front() = at(x, y, z, apex_);
  axis_.back() = at(x, y, z, outlet_);
}

double OrganRuler::sectionArea(int ring, const Values& x, const Values& y, const Values& z) {
  const Eigen::Vector3d along = (axis_[ring + 2] - axis_[ring]).normalized();
  const double near = kNear * static_cast<double>(ring_weight_.size());
  double area = 0;
  for (const auto& loop : section_.cut(x, y, z, axis_[ring + 1], along, label_))
    if (std::abs(loop.label - ring) < near) area += loop.area;
  return area;
}

void OrganRuler::measureBody(const Values& x, const Values& y, const Values& z, OrganMeasures& measures) {
  double length = 0, sum = 0, squares = 0, min = 0;
  for (int r = 0; r < static_cast<int>(in_body_.size()); ++r) {
    if (!in_body_[r]) continue;
    const double area = sectionArea(r, x, y, z);
    if (!(area > 0)) continue;  // the plane cuts this and another part of the organ in one
    const double part = 0.5 * ((axis_[r + 2] - axis_[r + 1]).norm() + (axis_[r + 1] - axis_[r]).norm());
    min = length == 0 ? area : std::min(min, area);
    length += part;
    sum += part * area;
    squares += part * area * area;
  }
  if (!(length > 0)) return;
  const double mean = sum / length;
  measures.body_length = length;
  measures.mean_area = mean;
  measures.min_area = min;
  if (mean > 0) measures.tubularity = 1 - std::sqrt(std::max(0.0, squares / length - mean * mean)) / mean;
}

double OrganRuler::curvature(const Values& x, const Values& y, const Values& z) const {
  double length = 0;
  Eigen::Vector3d last = at(x, y, z, apex_);
  for (const WallPoint& point : curvature_) {
    Eigen::Vector3d here = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k) here += point.weight[k] * at(x, y, z, point.corner[k]);
    length += (here - last).norm();
    last = here;
  }
  return length + (at(x, y, z, outlet_) - last).norm();
}

OrganMeasures OrganRuler::measure(const Values& x, const Values& y, const Values& z) {
  const std::size_t count = surface_.vertices.size();
  if (x.size() != count || y.size() != count || z.size() != count)
    throw Error(
        "An OrganRuler was given positions of another number of vertices than its organ has; give all of them.");
  OrganMeasures measures;
  measures.volume = lumenVolume(surface_, x, y, z);
  if (!std::isfinite(measures.volume))
    throw Error("An OrganRuler was given a position that is not finite; measure the organ before it is lost.");
  if (!has_axis_) return measures;
  placeRings(x, y, z);
  double length = 0;
  for (std::size_t k = 1; k < axis_.size(); ++k) length += (axis_[k] - axis_[k - 1]).norm();
  measures.length = length;
  measures.greater_curvature = curvature(x, y, z);
  measureBody(x, y, z, measures);
  return measures;
}

OrganMeasures OrganRuler::measureRest() {
  Values x, y, z;
  for (const auto& p : surface_.vertices) {
    x.push_back(p.x());
    y.push_back(p.y());
    z.push_back(p.z());
  }
  return measure(x, y, z);
}

std::optional<double> reduction(std::optional<double> before, std::optional<double> now) {
  if (!before || !now || !(*before > 0)) return std::nullopt;
  return 1 - *now / *before;
}

}  // namespace vibe
