#include "vibe_core/geometry/stomach_axis.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "arithmetic/elementary.hpp"
#include "geometry/surface_operators.hpp"

namespace vibe {

namespace {

constexpr int kMaxStations = 60;
constexpr int kVerticesPerStation = 8;  // at least
constexpr int kSmoothings = 3;          // of the curve, to even out irregular sections

}  // namespace

StomachAxis::StomachAxis(const SurfaceMesh& mesh, const std::vector<int>& fundus, const std::vector<int>& pylorus,
                         const std::vector<bool>& ignored, const Eigen::Vector3d& anterior) {
  const std::vector<double> field = harmonicField(mesh, fundus, pylorus);
  placeStations(mesh, field, ignored);
  orientStations(anterior);
  placeVertices(mesh, field);
}

void StomachAxis::placeStations(const SurfaceMesh& mesh, const std::vector<double>& field,
                                const std::vector<bool>& ignored) {
  std::vector<std::pair<double, int>> order;
  for (int v = 0; v < static_cast<int>(field.size()); ++v) {
    if (!ignored[v]) order.emplace_back(field[v], v);
  }
  std::sort(order.begin(), order.end());
  const int total = static_cast<int>(order.size());
  const int count = std::clamp(total / kVerticesPerStation, 4, kMaxStations);
  stations_.resize(count);
  level_.resize(count);
  for (int s = 0; s < count; ++s) {
    const int begin = s * total / count, end = (s + 1) * total / count;
    for (int k = begin; k < end; ++k) {
      stations_[s].centre += mesh.vertices[order[k].second] / (end - begin);
      level_[s] += order[k].first / (end - begin);
    }
  }
  for (int round = 0; round < kSmoothings; ++round) {
    const std::vector<Station> old = stations_;
    for (int s = 1; s + 1 < count; ++s) {
      stations_[s].centre = 0.25 * old[s - 1].centre + 0.5 * old[s].centre + 0.25 * old[s + 1].centre;
    }
  }
  for (int s = 1; s < count; ++s) {
    stations_[s].length = stations_[s - 1].length + (stations_[s].centre - stations_[s - 1].centre).norm();
  }
}

void StomachAxis::orientStations(const Eigen::Vector3d& anterior) {
  const int count = static_cast<int>(stations_.size());
  Eigen::Vector3d previous = anterior;
  for (int s = 0; s < count; ++s) {
    Station& station = stations_[s];
    const Eigen::Vector3d along = stations_[std::min(s + 1, count - 1)].centre - stations_[std::max(s - 1, 0)].centre;
    station.tangent = along.normalized();
    // where the organ runs to the front or the back, its front side determines the section poorly; there the direction
    // of the previous section has more weight
    const Eigen::Vector3d front = anterior - anterior.dot(station.tangent) * station.tangent;
    Eigen::Vector3d direction = previous - previous.dot(station.tangent) * station.tangent;
    direction = front.squaredNorm() * front + (1.0 - front.squaredNorm()) * direction;
    station.anterior = (direction - direction.dot(station.tangent) * station.tangent).normalized();
    station.greater = station.anterior.cross(station.tangent);
    previous = station.anterior;
  }
}

void StomachAxis::placeVertices(const SurfaceMesh& mesh, const std::vector<double>& field) {
  vertex_length_.resize(field.size());
  vertex_angle_.resize(field.size());
  const int last = static_cast<int>(stations_.size()) - 1;
  for (std::size_t v = 0; v < field.size(); ++v) {
    const auto above = std::upper_bound(level_.begin(), level_.end(), field[v]);
    const int next = std::clamp(static_cast<int>(above - level_.begin()), 1, last);
    const Station &a = stations_[next - 1], &b = stations_[next];
    const double gap = level_[next] - level_[next - 1];
    const double t = gap > 0.0 ? std::clamp((field[v] - level_[next - 1]) / gap, 0.0, 1.0) : 0.0;
    vertex_length_[v] = (1.0 - t) * a.length + t * b.length;
    const Eigen::Vector3d out = mesh.vertices[v] - ((1.0 - t) * a.centre + t * b.centre);
    const Eigen::Vector3d front = (1.0 - t) * a.anterior + t * b.anterior;
    const Eigen::Vector3d greater = (1.0 - t) * a.greater + t * b.greater;
    vertex_angle_[v] = math::atan2(out.dot(greater), out.dot(front));
  }
}

}  // namespace vibe
