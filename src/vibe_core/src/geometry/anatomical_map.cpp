#include "vibe_core/geometry/anatomical_map.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "geometry/regions.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/geometry/stomach_axis.hpp"
#include "vibe_core/geometry/surface_mesh.hpp"
#include "vibe_core/geometry/triangle_tree.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

constexpr double kStride = 1e-3;        // of a walk; a quarter of a particle's spacing, design choice [m]
constexpr double kNormalRadius = 6e-3;  // over which the wall's direction is averaged: as wide as the device's cap [m]
constexpr double kFarAlong = 0.05;      // of a place from the wall found for it, over the axis' length; design choice
constexpr double kFarAround = 0.35;     // and around the axis: the opening of a tube is as wide; design choice [rad]
constexpr double kApex = 0.05;          // along the axis: nearer to the apex, angles are not told apart
constexpr double kStalled = 0.2;        // of a stride: less is no progress; design choice
constexpr double kAlongWeight = 2.0;    // of the distance along the axis beside that around it; design choice
constexpr int kAxisVertices = 3500;  // at least, of the surface whose axis is found: 60 sections of as many; measured
constexpr int kHalvings = 16;        // of the way on which a border of two regions is looked for

Eigen::Vector3d weightsIn(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                          const Eigen::Vector3d& c) {
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double area2 = normal.squaredNorm();
  if (!(area2 > 0)) return Eigen::Vector3d::Constant(1. / 3);
  const double u = normal.dot((c - b).cross(p - b)) / area2, v = normal.dot((a - c).cross(p - c)) / area2;
  return {u, v, 1 - u - v};
}

// Of an organ in another shape: the landmark of the axis goes with its vertex.
Organ inShape(const Organ& organ, const std::vector<Eigen::Vector3d>& vertices) {
  Organ present = organ;
  const auto& rest = organ.surface.vertices;
  const auto nearer = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return (a - organ.landmarks.fundus).squaredNorm() < (b - organ.landmarks.fundus).squaredNorm();
  };
  const auto apex = std::min_element(rest.begin(), rest.end(), nearer) - rest.begin();
  present.landmarks.fundus = vertices[static_cast<std::size_t>(apex)];
  present.surface.vertices = vertices;
  return present;
}

// With its surface divided by Loop's scheme, the old vertices first: sections of the axis are means of vertices, and on
// a coarse surface they would depend on where the few vertices are. A new vertex is of an end if most of its weight is.
Organ divided(const Organ& coarse) {
  const RenderSurface finer = makeLoopSubdivision(coarse.surface);
  Organ organ;
  organ.landmarks = coarse.landmarks, organ.entry = coarse.entry;
  organ.surface = {renderPositions(finer, coarse.surface.vertices), finer.triangles};
  for (std::size_t v = 0; v + 1 < finer.offsets.size(); ++v) {
    std::array<double, 3> weight{};  // by End
    for (int k = finer.offsets[v]; k < finer.offsets[v + 1]; ++k)
      weight[static_cast<std::size_t>(coarse.end[finer.particles[k]])] += finer.weights[k];
    organ.end.push_back(static_cast<End>(std::max_element(weight.begin(), weight.end()) - weight.begin()));
  }
  return organ;
}

StomachAxis axisOf(Organ organ) {
  while (organ.surface.vertices.size() < kAxisVertices) organ = divided(organ);
  return findAxis(organ);
}

double turned(double angle) {
  return std::remainder(angle, 2 * M_PI);
}

std::string placeText(double along, double around) {
  return formatted("%.0f %% of the axis and %.0f deg around it", 100 * along, around * 180 / M_PI);
}

[[noreturn]] void failWalk(const char* why, double walked, double distance) {
  throw Error(formatted("%s after %.0f of %.0f mm along the wall; choose a place farther from there.", why,
                        1e3 * walked, 1e3 * std::abs(distance)));
}

}  // namespace

Eigen::Vector3d positionOf(const WallPoint& point, const std::vector<std::array<int, 3>>& triangles,
                           const std::vector<Eigen::Vector3d>& vertices) {
  const auto& corner = triangles[static_cast<std::size_t>(point.triangle)];
  return point.weight[0] * vertices[corner[0]] + point.weight[1] * vertices[corner[1]] +
         point.weight[2] * vertices[corner[2]];
}

Eigen::Vector3d outwardAt(const WallPoint& point, const std::vector<std::array<int, 3>>& triangles,
                          const std::vector<Eigen::Vector3d>& vertices) {
  const Eigen::Vector3d centre = positionOf(point, triangles, vertices);
  const auto normalOf = [&](const std::array<int, 3>& v) -> Eigen::Vector3d {
    return (vertices[v[1]] - vertices[v[0]]).cross(vertices[v[2]] - vertices[v[0]]);
  };
  const Eigen::Vector3d own = normalOf(triangles[static_cast<std::size_t>(point.triangle)]);
  constexpr double kBeside =
      3 * kNormalRadius * (1 + 1e-6);  // of three corners together, beyond which no middle is near
  Eigen::Vector3d sum = own;
  for (const auto& v : triangles) {
    const double beside = vertices[v[0]].x() + vertices[v[1]].x() + vertices[v[2]].x() - 3 * centre.x();
    if (beside * beside > kBeside * kBeside) continue;
    const Eigen::Vector3d middle = (vertices[v[0]] + vertices[v[1]] + vertices[v[2]]) / 3;
    if ((middle - centre).squaredNorm() > kNormalRadius * kNormalRadius) continue;
    const Eigen::Vector3d normal = normalOf(v);
    if (normal.dot(own) > 0) sum += normal;
  }
  return sum.normalized();
}

WallPoint nearestIn(int triangle, const Eigen::Vector3d& place, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                    const Eigen::Vector3d& c) {
  return {triangle, weightsIn(closestPointOnTriangle(place, a, b, c), a, b, c)};
}

WallPoint nearestOn(const Eigen::Vector3d& place, const WallPoint& same_side,
                    const std::vector<std::array<int, 3>>& triangles, const std::vector<Eigen::Vector3d>& vertices) {
  const Eigen::Vector3d outward = outwardAt(same_side, triangles, vertices);
  WallPoint best = same_side;
  double min = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Eigen::Vector3d &a = vertices[triangles[t][0]], &b = vertices[triangles[t][1]],
                          &c = vertices[triangles[t][2]];
    if ((b - a).cross(c - a).dot(outward) <= 0) continue;
    const double distance = (closestPointOnTriangle(place, a, b, c) - place).squaredNorm();
    if (distance < min) min = distance, best = nearestIn(static_cast<int>(t), place, a, b, c);
  }
  return best;
}

AnatomicalMap::AnatomicalMap(const Organ& organ, std::vector<Eigen::Vector3d> vertices)
    : triangles_(organ.surface.triangles), vertices_(std::move(vertices)) {
  const std::size_t count = vertices_.size();
  if (count != organ.surface.vertices.size())
    throw Error("Anatomical coordinates of " + std::to_string(organ.surface.vertices.size()) +
                " vertices need as many " + "positions, not " + std::to_string(count) + ".");
  for (std::size_t v = 0; v < count; ++v) end_.push_back(organ.end[v] != End::None);
  if (std::find(organ.end.begin(), organ.end.end(), End::Duodenum) == organ.end.end() ||
      std::find(organ.end.begin(), organ.end.end(), End::Oesophagus) == organ.end.end())
    throw Error(
        "The organ has no oesophagus or no duodenum, so it has no anatomical coordinates; give its landmarks in "
        "geometry.landmarks.");
  const StomachAxis axis = axisOf(inShape(organ, vertices_));
  axis_length_ = axis.length();
  for (std::size_t v = 0; v < count; ++v) {
    along_.push_back(axis.lengthAt(static_cast<int>(v)) / axis_length_);
    around_.push_back(turned(M_PI / 2 - axis.angleAt(static_cast<int>(v))));
  }
  findDirections();
  findRegions(organ);
}

void AnatomicalMap::findRegions(const Organ& organ) {
  extent_.fill({1, 0});
  for (std::size_t v = 0; v < along_.size(); ++v) {
    auto& extent = extent_[static_cast<std::size_t>(organ.region[v])];
    if (!end_[v]) extent = {std::min(extent.first, along_[v]), std::max(extent.second, along_[v])};
  }
  // The others end on the greater curvature where their definitions say, not at the last vertex before: labelStomach()
  const TriangleTree rest(organ.surface);
  const double incisura = alongLandmark(organ.landmarks.incisura, rest);
  const double pylorus = alongLandmark(organ.landmarks.pylorus, rest);
  double dome = extent_[static_cast<std::size_t>(Region::Fundus)].second;
  try {
    dome = alongAtHeight(organ.landmarks.oesophagus.z(), incisura, organ.surface.vertices);
  } catch (const Error&) {
    // a tube opens on the greater curvature, where the vertices have to do
  }
  const double canal = beginOfCanal(incisura * axis_length_, pylorus * axis_length_) / axis_length_;
  const auto set = [this](Region region, double begin, double end) {
    auto& extent = extent_[static_cast<std::size_t>(region)];
    // not of an organ whose landmarks are in another order along the axis
    if (extent.first <= extent.second && begin < end) extent = {begin, end};
  };
  set(Region::Fundus, 0, dome);
  set(Region::Body, dome, incisura);
  set(Region::Antrum, incisura, canal);
  set(Region::Pylorus, canal, extent_[static_cast<std::size_t>(Region::Pylorus)].second);
}

double AnatomicalMap::alongLandmark(const Eigen::Vector3d& landmark, const TriangleTree& rest) const {
  const TriangleTree::Hit hit = rest.closest(landmark);
  const auto& v = triangles_[static_cast<std::size_t>(hit.triangle)];
  const auto& corner = rest.mesh().vertices;
  return along(nearestIn(hit.triangle, hit.point, corner[v[0]], corner[v[1]], corner[v[2]]));
}

// The greater curvature descends from the apex to the incisura; `rest` is what the height is measured in.
double AnatomicalMap::alongAtHeight(double height, double incisura, const std::vector<Eigen::Vector3d>& rest) const {
  double above = 0, below = incisura;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (above + below);
    (positionOf(at(middle, 0), triangles_, rest).z() > height ? above : below) = middle;
  }
  return above;
}

double AnatomicalMap::alongIn(Region region, double share) const {
  const auto& [begin, end] = extent_[static_cast<std::size_t>(region)];
  if (begin > end) throw Error("The organ has no " + std::string(toString(region)) + "; choose a region that it has.");
  return begin + share * (end - begin);
}

void AnatomicalMap::findDirections() {
  const std::size_t count = vertices_.size();
  triangles_at_.resize(count);
  distal_.assign(count, Eigen::Vector3d::Zero());
  outward_.assign(count, Eigen::Vector3d::Zero());
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const auto& v = triangles_[t];
    const Eigen::Vector3d &a = vertices_[v[0]], &b = vertices_[v[1]], &c = vertices_[v[2]];
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    const double area2 = normal.squaredNorm();
    if (!(area2 > 0)) continue;
    // gradient of a linear function, times twice the area
    const Eigen::Vector3d slope =
        normal.cross(along_[v[0]] * (c - b) + along_[v[1]] * (a - c) + along_[v[2]] * (b - a)) / std::sqrt(area2);
    for (int corner : v) {
      triangles_at_[corner].push_back(static_cast<int>(t));
      distal_[corner] += slope;
      outward_[corner] += normal;
    }
  }
  for (std::size_t v = 0; v < count; ++v) {
    outward_[v].normalize();
    distal_[v] = (distal_[v] - outward_[v] * outward_[v].dot(distal_[v])).normalized();
  }
}

WallPoint AnatomicalMap::at(double along, double around) const {
  if (!(along >= 0 && along <= 1) || !std::isfinite(around))
    throw Error("There is no place at " + placeText(along, around) +
                "; along goes from 0 (apex of the fundus) to 100 % (duodenal end).");
  // the nearest point of all triangles, in units of the circumference at half the axis' length
  const Eigen::Vector3d wanted(kAlongWeight * along, 0, 0);
  WallPoint point;
  double min = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const auto& v = triangles_[t];
    if (inEnd(static_cast<int>(t))) continue;
    std::array<Eigen::Vector3d, 3> flat;
    for (std::size_t k = 0; k < 3; ++k)
      flat[k] = {kAlongWeight * along_[v[k]], turned(around_[v[k]] - around) / (2 * M_PI), 0};
    const auto [least, most] = std::minmax({flat[0].y(), flat[1].y(), flat[2].y()});
    if (most - least > 0.5) continue;  // behind the axis, where angles are cut
    const Eigen::Vector3d nearest = closestPointOnTriangle(wanted, flat[0], flat[1], flat[2]);
    const double miss = (nearest - wanted).squaredNorm();
    if (miss < min) min = miss, point = {static_cast<int>(t), weightsIn(nearest, flat[0], flat[1], flat[2])};
  }
  if (point.triangle < 0) throw Error("The organ's positions are not numbers, so it has no places; reset it.");
  const bool beside = along > kApex && std::abs(turned(this->around(point) - around)) > kFarAround;
  if (beside || std::abs(this->along(point) - along) > kFarAlong)
    throw Error("The organ has no wall at " + placeText(along, around) +
                ", where a tube opens; choose a place beside it.");
  return point;
}

double AnatomicalMap::along(const WallPoint& point) const {
  const auto& v = triangles_[static_cast<std::size_t>(point.triangle)];
  return point.weight[0] * along_[v[0]] + point.weight[1] * along_[v[1]] + point.weight[2] * along_[v[2]];
}

double AnatomicalMap::around(const WallPoint& point) const {
  const auto& v = triangles_[static_cast<std::size_t>(point.triangle)];
  const double first = around_[v[0]];
  return turned(first + point.weight[1] * turned(around_[v[1]] - first) +
                point.weight[2] * turned(around_[v[2]] - first));
}

Eigen::Vector3d AnatomicalMap::position(const WallPoint& point) const {
  return positionOf(point, triangles_, vertices_);
}

Eigen::Vector3d AnatomicalMap::outward(const WallPoint& point) const {
  return outwardAt(point, triangles_, vertices_);
}

Eigen::Vector2d AnatomicalMap::alongWall(const WallPoint& point, const Eigen::Vector3d& displacement) const {
  return {displacement.dot(direction(point, Way::Distal)), displacement.dot(direction(point, Way::Anterior))};
}

WallPoint AnatomicalMap::atVertex(int vertex) const {
  WallPoint point{triangles_at_[static_cast<std::size_t>(vertex)].front(), Eigen::Vector3d::Zero()};
  const auto& corners = triangles_[static_cast<std::size_t>(point.triangle)];
  for (int k = 0; k < 3; ++k) point.weight[k] = corners[k] == vertex ? 1 : 0;
  return point;
}

Eigen::Vector3d AnatomicalMap::direction(const WallPoint& point, Way way) const {
  const auto& v = triangles_[static_cast<std::size_t>(point.triangle)];
  Eigen::Vector3d ahead = Eigen::Vector3d::Zero(), out = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) ahead += point.weight[k] * distal_[v[k]], out += point.weight[k] * outward_[v[k]];
  out.normalize();
  ahead = (ahead - out * out.dot(ahead)).normalized();
  // tangent x greater = anterior
  return way == Way::Distal ? ahead : Eigen::Vector3d(ahead.cross(out));
}

WallPoint AnatomicalMap::nearest(const Eigen::Vector3d& place, int around_triangle) const {
  WallPoint best;
  double min = std::numeric_limits<double>::infinity();
  for (int corner : triangles_[static_cast<std::size_t>(around_triangle)])
    for (int t : triangles_at_[corner]) {
      const auto& v = triangles_[static_cast<std::size_t>(t)];
      const Eigen::Vector3d &a = vertices_[v[0]], &b = vertices_[v[1]], &c = vertices_[v[2]];
      const Eigen::Vector3d point = closestPointOnTriangle(place, a, b, c);
      const double distance = (point - place).squaredNorm();
      if (distance < min) min = distance, best = {t, weightsIn(point, a, b, c)};
    }
  return best;
}

bool AnatomicalMap::inEnd(int triangle) const {
  const auto& v = triangles_[static_cast<std::size_t>(triangle)];
  return end_[v[0]] && end_[v[1]] && end_[v[2]];
}

WallPoint AnatomicalMap::walkStraight(WallPoint from, double distance, Way way) const {
  const int strides = static_cast<int>(std::ceil(std::abs(distance) / kStride));
  const double stride = distance / std::max(strides, 1);
  Eigen::Vector3d heading = direction(from, way);
  double turn = 0;
  for (int k = 0; k < strides; ++k) {
    const WallPoint last = from;
    from = nearest(position(last) + stride * heading, last.triangle);
    const Eigen::Vector3d ahead = direction(from, way);
    const double walked = (k + 1) * std::abs(stride);
    if (inEnd(from.triangle)) failWalk("The organ ends", walked, distance);
    if ((position(from) - position(last)).norm() < kStalled * std::abs(stride) || ahead.dot(heading) < 0)
      failWalk("The way leads over the apex of the fundus", walked, distance);
    turn += turned(around(from) - around(last));
    if (way == Way::Anterior && std::abs(turn) > M_PI)
      failWalk("The way is more than half around the organ", walked, distance);
    heading = ahead;
  }
  return from;
}

WallPoint AnatomicalMap::walk(const WallPoint& from, double distal, double anterior) const {
  return walkStraight(walkStraight(from, distal, Way::Distal), anterior, Way::Anterior);
}

}  // namespace vibe
