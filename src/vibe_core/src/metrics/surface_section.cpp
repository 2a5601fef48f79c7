#include "vibe_core/metrics/surface_section.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "vibe_core/program/error.hpp"

namespace vibe {

SurfaceSection::SurfaceSection(const SurfaceMesh& surface) : triangles_(surface.triangles) {
  std::map<std::pair<int, int>, int> triangle_of;  // of every directed edge
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (int k = 0; k < 3; ++k) triangle_of[{triangles_[t][k], triangles_[t][(k + 1) % 3]}] = static_cast<int>(t);
  neighbour_.resize(triangles_.size());
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const auto other = triangle_of.find({triangles_[t][(k + 1) % 3], triangles_[t][k]});
      if (other == triangle_of.end())
        throw Error("Triangle " + std::to_string(t) + " of the surface to cut has an edge without a neighbour; " +
                    "close the surface and orient its triangles outwards.");
      neighbour_[t][k] = other->second;
    }
  }
  done_.resize(triangles_.size());
  height_.resize(surface.vertices.size());
  above_.resize(surface.vertices.size());
  loops_.reserve(16);
}

/// The edge on which a walk around the triangle goes below the plane; -1 if the plane does not cut it.
int SurfaceSection::downEdge(int triangle) const {
  constexpr int kEdge[8] = {-1, 0, 1, 1, 2, 0, 2, -1};  // by which corners are above: 1 first, 2 second, 4 third
  const auto& t = triangles_[triangle];
  return kEdge[above_[t[0]] + 2 * above_[t[1]] + 4 * above_[t[2]]];
}

const std::vector<SurfaceSection::Loop>& SurfaceSection::cut(const std::vector<double>& x, const std::vector<double>& y,
                                                             const std::vector<double>& z, const Eigen::Vector3d& point,
                                                             const Eigen::Vector3d& normal,
                                                             const std::vector<double>& label) {
  const double offset = normal.dot(point);
  for (std::size_t v = 0; v < height_.size(); ++v) {
    height_[v] = normal.x() * x[v] + normal.y() * y[v] + normal.z() * z[v] - offset;
    above_[v] = height_[v] >= 0;
  }
  std::fill(done_.begin(), done_.end(), char{0});
  loops_.clear();
  for (int t = 0; t < static_cast<int>(triangles_.size()); ++t)
    if (!done_[t] && downEdge(t) >= 0) loops_.push_back(trace(t, x, y, z, point, normal, label));
  return loops_;
}

/// Walks from triangle to triangle: in over the edge that goes down, out over the one that goes up, which the next one
/// sees go down. With the outside on the right hand this runs counter-clockwise seen against the normal.
SurfaceSection::Loop SurfaceSection::trace(int first, const std::vector<double>& x, const std::vector<double>& y,
                                           const std::vector<double>& z, const Eigen::Vector3d& point,
                                           const Eigen::Vector3d& normal, const std::vector<double>& label) {
  Loop loop;
  int labelled = 0;
  Eigen::Vector3d last = Eigen::Vector3d::Zero(), start = last;
  for (int t = first; !done_[t];) {
    done_[t] = 1;
    const auto& corner = triangles_[t];
    const int down = downEdge(t), a = corner[down], b = corner[(down + 1) % 3], c = corner[(down + 2) % 3];
    const double share = height_[a] / (height_[a] - height_[b]);
    const Eigen::Vector3d pa(x[a], y[a], z[a]), pb(x[b], y[b], z[b]);
    const Eigen::Vector3d crossing = pa + share * (pb - pa) - point;
    if (t == first) start = crossing;
    loop.area += 0.5 * normal.dot(last.cross(crossing));
    for (int v : {a, b}) {
      if (std::isnan(label[v])) continue;
      loop.label += label[v];
      ++labelled;
    }
    last = crossing;
    t = neighbour_[t][above_[c] ? (down + 1) % 3 : (down + 2) % 3];
  }
  loop.area += 0.5 * normal.dot(last.cross(start));
  loop.label /= labelled;  // NaN for none
  return loop;
}

}  // namespace vibe
