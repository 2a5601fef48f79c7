#include "contact/tool_approach.hpp"

#include <algorithm>

namespace vibe {

namespace {

constexpr int kAdvances = 40;     // steps towards a contact; each takes nine tenths of what is free
constexpr double kAdvance = 0.9;  // of the distance above the floor per step [1]
constexpr double kKept = 0.1;     // of that distance at the start, at which an approach ends [1]

using Triangle = std::array<Eigen::Vector3d, 3>;

Triangle triangleAt(const SurfacePath& path, const std::array<int, 3>& n, double fraction) {
  return {path.at(n[0], fraction), path.at(n[1], fraction), path.at(n[2], fraction)};
}

// A bound of the relative motion of the two; what they have in common does not count.
double closingSpeed(const SweptTool& tool, int shape, const SurfacePath& path, const std::array<int, 3>& triangle) {
  const std::array<Eigen::Vector3d, 2> moves = tool.moves(shape);
  const Eigen::Vector3d common = 0.5 * (moves[0] + moves[1]);
  double wall = 0;
  for (const int v : triangle) wall = std::max(wall, (path.at(v, 1) - path.start(v) - common).norm());
  const double turn = 0.5 * (moves[1] - moves[0]).norm();
  return wall + (tool.radius(shape) > 0 ? turn : tool.travel(shape) + common.norm());
}

}  // namespace

ToolApproach approach(const SweptTool& tool, int shape, const SurfacePath& path, const std::array<int, 3>& triangle,
                      double floor) {
  const double speed = closingSpeed(tool, shape, path, triangle);
  ToolApproach result;
  result.fraction = 0;
  result.gap = tool.gap(shape, 0, triangleAt(path, triangle, 0));
  result.nearest = result.gap.distance;
  const double kept = kKept * (result.gap.distance - floor);
  for (int advance = 0; advance < kAdvances && result.fraction < 1; ++advance) {
    const double free = result.gap.distance - floor;
    if (free <= 0 || (advance > 0 && free < kept)) break;
    const double left = 1 - result.fraction;
    const double next = free >= left * speed ? 1 : std::min(1.0, result.fraction + kAdvance * free / speed);
    result.gap = tool.gap(shape, next, triangleAt(path, triangle, next));
    result.fraction = next;
  }
  result.nearest = std::min(result.nearest, result.gap.distance);
  return result;
}

NearTriangles::NearTriangles(const SurfaceMesh& surface, const std::vector<char>& passable)
    : outside_(surface.vertices.size()) {
  for (const std::array<int, 3>& n : surface.triangles)
    if (passable[n[0]] == 0 && passable[n[1]] == 0 && passable[n[2]] == 0) triangles_.push_back(n);
}

void NearTriangles::classify(const Eigen::AlignedBox3d& box, const SurfacePath& path) {
  std::fill(outside_.begin(), outside_.end(), static_cast<unsigned char>(0));
  for (std::size_t k = 0; k < 3; ++k) {
    const double low = box.min()[static_cast<int>(k)], high = box.max()[static_cast<int>(k)];
    const double *const from = path.from[k], *const to = path.to[k];
    const unsigned below = 1U << (2 * k), above = 2U << (2 * k);
    for (std::size_t i = 0; i < outside_.size(); ++i) {
      const unsigned is_below = static_cast<unsigned>(from[i] < low) & static_cast<unsigned>(to[i] < low);
      const unsigned is_above = static_cast<unsigned>(from[i] > high) & static_cast<unsigned>(to[i] > high);
      outside_[i] = static_cast<unsigned char>(outside_[i] | (is_below * below) | (is_above * above));
    }
  }
}

void NearTriangles::find(const SweptTool& tool, const SurfacePath& path, double reach, std::vector<Pair>& found) {
  found.clear();
  Eigen::AlignedBox3d all = tool.box();
  all.min().array() -= reach, all.max().array() += reach;
  classify(all, path);
  inside_.clear(), box_.clear();
  for (int t = 0; t < static_cast<int>(triangles_.size()); ++t) {
    const std::array<int, 3>& n = triangles_[t];
    if ((outside_[n[0]] & outside_[n[1]] & outside_[n[2]]) != 0) continue;
    Eigen::AlignedBox3d box;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const int v : n) {
      const Eigen::Vector3d from = path.start(v), to = path.at(v, 1);
      box.extend(from), box.extend(to);
      sum += from + to;
    }
    if (!sum.allFinite()) continue;
    box.min().array() -= reach, box.max().array() += reach;
    inside_.push_back(t), box_.push_back(box);
  }
  for (int s = 0; s < tool.count(); ++s)
    for (std::size_t k = 0; k < inside_.size(); ++k)
      if (tool.box(s).intersects(box_[k])) found.push_back({s, inside_[k]});
}

}  // namespace vibe
