#include "suture/wall_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "vibe_core/program/error.hpp"

namespace vibe::benchmarks {

namespace {

constexpr double kGreater = 1.57079632679489662;  // angle of the greater curvature around the axis [rad]
constexpr double kFarthest = 2.6;                 // largest angle from it; the lesser curvature is at pi [rad]
constexpr double kAngleStep = 0.02;               // [rad]
constexpr int kCurveSamples = 200;

/// The station interpolated between those on both sides of a position along the axis.
StomachAxis::Station stationAt(const StomachAxis& axis, double length) {
  const auto& stations = axis.stations();
  const auto next = std::lower_bound(stations.begin() + 1, stations.end() - 1, length,
                                     [](const StomachAxis::Station& s, double l) { return s.length < l; });
  const StomachAxis::Station &a = *(next - 1), &b = *next;
  const double part = std::clamp((length - a.length) / (b.length - a.length), 0.0, 1.0);
  StomachAxis::Station mixed = a;
  mixed.length = length;
  mixed.centre = (1 - part) * a.centre + part * b.centre;
  mixed.anterior = ((1 - part) * a.anterior + part * b.anterior).normalized();
  mixed.greater = ((1 - part) * a.greater + part * b.greater).normalized();
  return mixed;
}

Eigen::Vector3d cornerWeights(const SurfaceMesh& mesh, int triangle, const Eigen::Vector3d& p) {
  const auto& corners = mesh.triangles[triangle];
  const Eigen::Vector3d a = mesh.vertices[corners[0]];
  const Eigen::Vector3d ab = mesh.vertices[corners[1]] - a, ac = mesh.vertices[corners[2]] - a;
  const Eigen::Vector3d normal = ab.cross(ac);
  const double square = normal.squaredNorm();
  const double wb = (p - a).cross(ac).dot(normal) / square, wc = ab.cross(p - a).dot(normal) / square;
  return {1 - wb - wc, wb, wc};
}

}  // namespace

Eigen::Vector3d placeOf(const WallSpot& spot, const SurfaceView& wall) {
  const auto& corners = wall.triangles[spot.triangle];
  return spot.weight[0] * wall.position(corners[0]) + spot.weight[1] * wall.position(corners[1]) +
         spot.weight[2] * wall.position(corners[2]);
}

WallPlan::WallPlan(const Organ& organ, const SurfaceView& wall)
    : axis_(findAxis(organ)), rest_(organ.surface), wall_(wall) {
  double proximal = std::numeric_limits<double>::infinity(), distal = -proximal;
  for (std::size_t v = 0; v < organ.region.size(); ++v) {
    if (organ.region[v] != Region::Body || organ.wall[v] != Wall::GreaterCurvature) continue;
    proximal = std::min(proximal, axis_.lengthAt(static_cast<int>(v)));
    distal = std::max(distal, axis_.lengthAt(static_cast<int>(v)));
  }
  if (!(distal > proximal))
    throw Error("The organ has no greater curvature of a body; plan sutures on a stomach with its landmarks.");
  Eigen::Vector3d last;
  for (int k = 0; k <= kCurveSamples; ++k) {
    const double at = distal + (proximal - distal) * k / kCurveSamples;
    const Eigen::Vector3d here = placeOf(spotAt(at, kGreater), wall_);
    curve_length_.push_back(k == 0 ? 0 : curve_length_.back() + (here - last).norm());
    curve_axis_.push_back(at);
    last = here;
  }
}

WallSpot WallPlan::spotAt(double axis_length, double angle) const {
  const StomachAxis::Station station = stationAt(axis_, axis_length);
  const Eigen::Vector3d ray = (std::cos(angle) * station.anterior + std::sin(angle) * station.greater).normalized();
  const double distance = rest_.firstHit(station.centre, ray);
  if (!std::isfinite(distance))
    throw Error("The axis of the organ leaves its lumen; check the mesh and its landmarks.");
  const TriangleTree::Hit hit = rest_.closest(station.centre + distance * ray);
  return {hit.triangle, cornerWeights(rest_.mesh(), hit.triangle, hit.point)};
}

double WallPlan::axisLengthAt(double along) const {
  const auto next = std::lower_bound(curve_length_.begin() + 1, curve_length_.end() - 1, along);
  const std::size_t k = static_cast<std::size_t>(next - curve_length_.begin());
  const double step = curve_length_[k] - curve_length_[k - 1];
  const double part = step > 0 ? std::clamp((along - curve_length_[k - 1]) / step, 0.0, 1.0) : 0;
  return (1 - part) * curve_axis_[k - 1] + part * curve_axis_[k];
}

WallSpot WallPlan::at(double along, double across) const {
  const double axis_length = axisLengthAt(along), sign = across < 0 ? -1 : 1;
  double walked = 0;
  WallSpot spot = spotAt(axis_length, kGreater);
  Eigen::Vector3d last = placeOf(spot, wall_);
  for (double turned = 0; walked < std::abs(across);) {
    turned += kAngleStep;
    if (turned > kFarthest)
      throw Error("A bite " + std::to_string(std::abs(across) * 1e3) +
                  " mm from the greater curvature lies on the lesser one; make the pattern narrower.");
    const WallSpot next = spotAt(axis_length, kGreater + sign * turned);
    const Eigen::Vector3d here = placeOf(next, wall_);
    const double step = (here - last).norm();
    if (walked + step >= std::abs(across)) {
      const double part = step > 0 ? (std::abs(across) - walked) / step : 1;
      return spotAt(axis_length, kGreater + sign * (turned - (1 - part) * kAngleStep));
    }
    walked += step;
    spot = next;
    last = here;
  }
  return spot;
}

std::vector<Eigen::Vector2d> bitesOfU(int bites) {
  if (bites < 4 || bites % 3 != 1)
    throw Error("A pattern of " + std::to_string(bites) +
                " bites cannot have three equal legs; ask for 4, 7 or 10 bites per set.");
  const int vectors = (bites - 1) / 3;
  const std::array<Eigen::Vector2d, 4> corners{{{-1, 0}, {1, 0}, {1, 1}, {-1, 1}}};
  std::vector<Eigen::Vector2d> places{corners.front()};
  for (std::size_t leg = 1; leg < corners.size(); ++leg)
    for (int k = 1; k <= vectors; ++k)
      places.push_back(corners[leg - 1] + (corners[leg] - corners[leg - 1]) * k / vectors);
  return places;
}

std::vector<std::vector<WallSpot>> planSets(const WallPlan& plan, const SetLayout& layout) {
  const std::vector<Eigen::Vector2d> drawing = bitesOfU(layout.bites);
  const double pitch = plan.length() / layout.sets;
  std::vector<std::vector<WallSpot>> sets;
  for (int k = 0; k < layout.sets; ++k) {
    const double begin = pitch * (k + 0.5 * (1 - layout.share));
    sets.emplace_back();
    for (const Eigen::Vector2d& p : drawing)
      sets.back().push_back(plan.at(begin + layout.share * pitch * p.y(), layout.half_width * p.x()));
  }
  return sets;
}

}  // namespace vibe::benchmarks
