#include "contact/tool_guard.hpp"

#include <algorithm>

namespace vibe {

namespace {

// Share of the wall's thickness that stays between a shape and the mid-surface. Design choice: far below what
// contacts keep, far above rounding and what a joint's path differs from a straight one [1].
constexpr double kKept = 0.05;
// What is nearer already may come nearer by a tenth in a step, and never meets [1].
constexpr double kNearer = 0.9;
// Attempts to stop the tool on its way before it stays where it was. Design choice: each costs a search.
constexpr int kStops = 4;
// Share of the free part of the way that the tool takes. Design choice: leaves a distance from which the next step can
// go on [1].
constexpr double kPart = 0.9;

}  // namespace

ToolGuard::ToolGuard(const ToolModel& tool, const SurfaceMesh& surface, const std::vector<double>& thickness,
                     const std::vector<char>& passable)
    : thickness_(thickness), tool_(tool), near_(surface, passable) {}

ToolGuard::Free ToolGuard::keepApart(ToolPoses& poses, const ToolMotion& motion, const SurfacePath& path) {
  Free free;
  double part = freePart(poses.start, poses.end, path);
  for (int stop = 1; part < 1 && stop <= kStops; ++stop) {
    free.tool = stop < kStops ? kPart * part * free.tool : 0;
    motion.linkPoses(free.tool, poses.end);
    part = freePart(poses.start, poses.end, path);
  }
  free.wall = part;
  return free;
}

double ToolGuard::freePart(const std::vector<Eigen::Isometry3d>& start, const std::vector<Eigen::Isometry3d>& end,
                           const SurfacePath& path) {
  tool_.place(start, end);
  near_.find(tool_, path, kKept * *std::max_element(thickness_.begin(), thickness_.end()), pairs_);
  double part = 1;
  for (const NearTriangles::Pair& pair : pairs_) part = std::min(part, freePart(pair, path));
  return part;
}

double ToolGuard::freePart(const NearTriangles::Pair& pair, const SurfacePath& path) const {
  const std::array<int, 3>& n = near_.triangles()[pair.triangle];
  const double radius = tool_.radius(pair.shape);
  const TriangleGap gap = tool_.gap(pair.shape, 0, {path.start(n[0]), path.start(n[1]), path.start(n[2])});
  const double thinnest = std::min({thickness_[n[0]], thickness_[n[1]], thickness_[n[2]]});
  if (gap.distance == 0) return 1;  // they crossed before
  const double outside = gap.distance - radius;
  const double floor = outside > 0 ? radius + std::min(kKept * thinnest, kNearer * outside) : kNearer * gap.distance;
  if (gap.distance - closingDistance(tool_, pair.shape, path, n) > floor) return 1;
  return approach(tool_, pair.shape, path, n, floor).fraction;
}

}  // namespace vibe
