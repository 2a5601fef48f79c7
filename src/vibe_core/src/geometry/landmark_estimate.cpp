#include "geometry/regions.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "arithmetic/elementary.hpp"
#include "arithmetic/turn.hpp"
#include "geometry/surface_operators.hpp"
#include "vibe_core/geometry/stomach_axis.hpp"
#include "vibe_core/geometry/triangle_tree.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

constexpr double kPatch = 0.125;        // radius of the ends of the axis over the size of the organ; 12 mm at 0.9 L
constexpr double kIncisuraBegin = 0.4;  // along the axis: the incisura lies between body and antrum
constexpr double kIncisuraEnd = 0.85;
constexpr double kAround = 0.15;           // over the size of the organ: where the width of the lumen is looked at
constexpr double kOffWall = 1e-3;          // over that: where a ray across the lumen starts
constexpr double kWide = 0.4;              // over the size of the organ: the lumen of a fundus, but of no tube
constexpr double kTilt = 20 * M_PI / 180;  // design choice: axes of a file that are off by more are a mistake
constexpr double kSamePlace = 0.31;        // over the size of the organ; 3 cm at 0.9 L

struct Mark {
  double value;
  const char* doubt;
};

double ramp(double value, double nothing, double all) {
  return std::clamp((value - nothing) / (all - nothing), 0.0, 1.0);
}

std::vector<int> verticesInBall(const SurfaceMesh& mesh, const Eigen::Vector3d& centre, double radius) {
  std::vector<int> list;
  for (int v = 0; v < static_cast<int>(mesh.vertices.size()); ++v)
    if ((mesh.vertices[v] - centre).norm() <= radius) list.push_back(v);
  return list;
}

// How wide the lumen is inside of every vertex [m]. A quarter of the vertices around it may have less, so that the end
// of a tube is as narrow as the tube.
std::vector<double> lumenWidths(const SurfaceMesh& mesh, double around) {
  const TriangleTree tree(mesh);
  const std::vector<Eigen::Vector3d> normals = vertexNormals(mesh);
  std::vector<double> across, widths;
  for (std::size_t v = 0; v < normals.size(); ++v)
    across.push_back(tree.firstHit(mesh.vertices[v] - kOffWall * around * normals[v], -normals[v]));
  for (const Eigen::Vector3d& centre : mesh.vertices) {
    std::vector<double> near;
    for (int v : verticesInBall(mesh, centre, around)) near.push_back(across[v]);
    const auto quarter = near.begin() + static_cast<std::ptrdiff_t>(near.size() / 4);
    std::nth_element(near.begin(), quarter, near.end());
    widths.push_back(*quarter);
  }
  return widths;
}

// A surface between the apex of its dome and its far end.
class Reading {
 public:
  /// @param width  of the lumen, per vertex [m]
  Reading(const SurfaceMesh& mesh, const std::vector<double>& width)
      : mesh_(mesh),
        size_(math::cbrt(enclosedVolume(mesh))),
        apex_(highest(mesh, width, size_)),
        far_(farthest(mesh, apex_, width)),
        far_width_(width[far_]),
        axis_(mesh, verticesInBall(mesh, mesh.vertices[apex_], kPatch * size_),
              verticesInBall(mesh, mesh.vertices[far_], kPatch * size_), std::vector<bool>(mesh.vertices.size()),
              Eigen::Vector3d::UnitX()) {
    findLesserCurvature();
  }

  Landmarks landmarks() const;
  std::vector<Mark> marks() const;
  double length() const { return axis_.length(); }

 private:
  // where the lumen is wide: not on a stump of the oesophagus
  static int highest(const SurfaceMesh& mesh, const std::vector<double>& width, double size) {
    int best = -1;
    for (int v = 0; v < static_cast<int>(width.size()); ++v)
      if (width[v] > kWide * size && (best < 0 || mesh.vertices[v].z() > mesh.vertices[best].z())) best = v;
    if (best < 0)
      throw Error("The surface is not like a stomach: it is wide nowhere, so its landmarks cannot be guessed.");
    return best;
  }
  // among places equally far, a narrow one
  static int farthest(const SurfaceMesh& mesh, int from, const std::vector<double>& width) {
    const std::vector<double> distance = edgeDistances(mesh, {from});
    int best = from;
    for (int v = 0; v < static_cast<int>(width.size()); ++v)
      if (distance[v] - width[v] > distance[best] - width[best]) best = v;
    return best;
  }
  void findLesserCurvature();
  double radius(double from, double to) const;
  Eigen::Vector3d course(double from, double to) const;
  double share(std::size_t station) const { return axis_.stations()[station].length / axis_.length(); }

  const SurfaceMesh& mesh_;
  double size_;  // edge of a cube of the same volume [m]
  int apex_, far_;
  double far_width_;  // of the lumen at the far end [m]
  StomachAxis axis_;
  std::vector<Eigen::Vector3d> lesser_;  // per station
};

// The vertex of every section that is nearest to that side.
void Reading::findLesserCurvature() {
  const auto& stations = axis_.stations();
  for (std::size_t s = 0; s < stations.size(); ++s) {
    const double begin = stations[s > 0 ? s - 1 : s].length,
                 end = stations[std::min(s + 1, stations.size() - 1)].length;
    int best = apex_;
    double min = M_PI;
    for (int v = 0; v < static_cast<int>(mesh_.vertices.size()); ++v) {
      if (axis_.lengthAt(v) < begin || axis_.lengthAt(v) > end) continue;
      const double angle = std::abs(std::remainder(axis_.angleAt(v) + M_PI / 2, 2 * M_PI));
      if (angle < min) min = angle, best = v;
    }
    lesser_.push_back(mesh_.vertices[best]);
  }
}

// Mean distance of the wall from the axis in a part of its length.
double Reading::radius(double from, double to) const {
  const auto& stations = axis_.stations();
  double sum = 0;
  int count = 0;
  for (int v = 0; v < static_cast<int>(mesh_.vertices.size()); ++v) {
    const double at = axis_.lengthAt(v);
    if (at < from * axis_.length() || at > to * axis_.length()) continue;
    const auto next = std::lower_bound(stations.begin(), stations.end() - 1, at,
                                       [](const StomachAxis::Station& s, double length) { return s.length < length; });
    sum += (mesh_.vertices[v] - next->centre).norm();
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

// Mean direction of the axis in a part of its length.
Eigen::Vector3d Reading::course(double from, double to) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t s = 0; s < lesser_.size(); ++s)
    if (share(s) >= from && share(s) <= to) sum += axis_.stations()[s].tangent;
  return sum.normalized();
}

Landmarks Reading::landmarks() const {
  Landmarks found;
  found.fundus = mesh_.vertices[apex_];
  found.pylorus = mesh_.vertices[far_];
  const double floor = found.fundus.z() - radius(0.25, 0.5);
  std::size_t junction = 1;
  while (junction + 1 < lesser_.size() && share(junction) < kIncisuraBegin && lesser_[junction].z() > floor) ++junction;
  found.oesophagus = lesser_[junction];
  const Eigen::Vector3d chord = (found.pylorus - found.oesophagus).normalized();
  double most = -1;
  for (std::size_t s = junction; s < lesser_.size(); ++s) {
    if (share(s) < kIncisuraBegin || share(s) > kIncisuraEnd) continue;
    const double distance = (lesser_[s] - found.oesophagus).cross(chord).norm();
    if (distance > most) most = distance, found.incisura = lesser_[s];
  }
  return found;
}

std::vector<Mark> Reading::marks() const {
  const double narrowing = radius(0.25, 0.5) / radius(0.85, 0.97);
  const Eigen::Vector3d first = course(0.15, 0.45), last = course(0.75, 0.95);
  const double bend = math::acos(std::clamp(first.dot(last), -1.0, 1.0));
  const Eigen::Vector3d way = (mesh_.vertices[far_] - mesh_.vertices[apex_]) / size_;
  const double frontal = std::abs(first.cross(last).normalized().x());
  return {{ramp(narrowing, 1.5, 2), "it does not narrow towards its far end"},
          {1 - ramp(far_width_ / radius(0.25, 0.5), 0.6, 0.9), "its far end is wide"},
          {ramp(bend, 15 * M_PI / 180, 35 * M_PI / 180), "it does not bend as a stomach does"},
          {ramp(-way.y(), 0, 0.4), "its far end does not lie to the patient's right of its highest point"},
          {ramp(-way.z(), 0, 0.4), "its far end does not lie below its highest point"},
          {ramp(frontal, 0.5, 0.8), "its bend does not lie in the frontal plane"}};
}

std::array<Eigen::Vector3d, 4> placesOf(const Landmarks& l) {
  return {l.oesophagus, l.fundus, l.incisura, l.pylorus};
}

Landmarks seenTilted(const SurfaceMesh& surface, const std::vector<double>& width, const Eigen::Matrix3d& tilt) {
  SurfaceMesh tilted = surface;
  for (Eigen::Vector3d& v : tilted.vertices) v = tilt * v;
  Landmarks found = Reading(tilted, width).landmarks();
  for (Eigen::Vector3d* p : {&found.oesophagus, &found.fundus, &found.incisura, &found.pylorus})
    *p = tilt.transpose() * *p;
  return found;
}

// Share of the tilted views that agree; notes the spread.
Mark steadiness(const SurfaceMesh& surface, const std::vector<double>& width, LandmarkEstimate& estimate) {
  const double size = math::cbrt(enclosedVolume(surface));
  const auto here = placesOf(estimate.landmarks);
  int views = 0, same = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const double angle : {-kTilt, kTilt}) {
      const Eigen::Matrix3d tilt = rotationAbout(Eigen::Vector3d::Unit(axis), angle);
      const auto there = placesOf(seenTilted(surface, width, tilt));
      bool agrees = true;
      for (std::size_t k = 0; k < here.size(); ++k) {
        const double distance = (there[k] - here[k]).norm();
        estimate.spread[k] = std::max(estimate.spread[k], distance);
        agrees = agrees && distance <= kSamePlace * size;
      }
      ++views, same += agrees ? 1 : 0;
    }
  return {static_cast<double>(same) / views, "its landmarks move when its axes are tilted"};
}

}  // namespace

LandmarkEstimate estimateLandmarks(const SurfaceMesh& surface) {
  const std::vector<double> width = lumenWidths(surface, kAround * math::cbrt(enclosedVolume(surface)));
  const Reading reading(surface, width);
  LandmarkEstimate estimate;
  estimate.landmarks = reading.landmarks();
  estimate.length = reading.length();
  estimate.confidence = 1;
  std::vector<Mark> marks = reading.marks();
  marks.push_back(steadiness(surface, width, estimate));
  for (const Mark& mark : marks)
    if (mark.value < estimate.confidence) estimate.confidence = mark.value, estimate.doubt = mark.doubt;
  if (estimate.confidence <= 0)
    throw Error("The surface is not like a stomach: " + estimate.doubt + ", so its landmarks cannot be guessed.");
  return estimate;
}

}  // namespace vibe
