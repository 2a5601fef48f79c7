#include "tool_contact/tool_guard.hpp"

#include <algorithm>
#include <array>

namespace vibe {

namespace {

// Share of the wall's thickness that stays between a shape and the mid-surface. Design choice: far below what
// contacts keep, far above rounding and what a joint's path differs from a straight one [1].
constexpr double kKeptThickness = 0.05;
// What is nearer already may come nearer by a tenth in a step, and never meets [1].
constexpr double kNearer = 0.9;
// Where less than this share of the thickness is left, only rounding may bring the two nearer: a distance that shrinks
// by a part of itself in every step would become too small to get free from [1].
constexpr double kLeastThickness = 1e-3, kHardlyNearer = 1 - 1e-6;
// Attempts to stop the tool on its way before it stays where it was. Design choice: each costs a search.
constexpr int kStopAttempts = 4;
// Share of the free part of the way that the tool takes. Design choice: leaves a distance from which the next step can
// go on [1].
constexpr double kTakenShare = 0.9;
// Parts of what is left of its way that a joint tries. Design choice: each costs a search [1].
constexpr std::array<double, 2> kJointParts{1, 0.25};

}  // namespace

ToolGuard::ToolGuard(const ToolModel& tool, const SurfaceMesh& surface, const std::vector<double>& thickness,
                     const std::vector<char>& passable)
    : thickness_(thickness), on_tip_(shapesOnTip(tool)), tool_(tool), near_(surface, passable) {}

double ToolGuard::keepApart(ToolPoses& poses, ToolMotion& motion, const SurfacePath& path,
                            const std::vector<int>& held) {
  held_ = held;
  double free = freePart(poses, motion, path);
  if (free == 1) return 1;
  const ToolMotion wanted = motion;
  for (int stop = 1; free < 1 && stop <= kStopAttempts; ++stop) {
    motion.stop(stop < kStopAttempts ? kTakenShare * free : 0);
    free = freePart(poses, motion, path);
  }
  SurfacePath rest = path;
  rest.part *= free;
  moveJoints(poses, wanted, rest, motion);
  motion.linkPoses(1, poses.end);
  return free;
}

bool ToolGuard::stop(ToolPoses& poses, ToolMotion& motion, const SurfacePath& path, const std::vector<int>& held) {
  held_ = held;
  const double free = freePart(poses, motion, path);
  if (free == 1) return false;
  blocking_vertex_ = worst_;
  const ToolMotion wanted = motion;
  motion.stop(kTakenShare * free);
  SurfacePath there = path;
  there.part *= free;
  moveJoints(poses, wanted, there, motion);
  motion.linkPoses(1, poses.end);
  return true;
}

const std::vector<int>& ToolGuard::meets(ToolPoses& poses, const ToolMotion& motion, const SurfacePath& path,
                                         const std::vector<int>& held) {
  held_ = held;
  met_.clear();
  if (freePart(poses, motion, path) == 1) return met_;
  for (const NearTriangles::Pair& pair : pairs_)
    if (!isDrawnIn(pair) && freePart(pair, path) < 1)
      met_.insert(met_.end(), near_.triangles()[pair.triangle].begin(), near_.triangles()[pair.triangle].end());
  std::sort(met_.begin(), met_.end());
  met_.erase(std::unique(met_.begin(), met_.end()), met_.end());
  return met_;
}

void ToolGuard::moveJoints(ToolPoses& poses, const ToolMotion& wanted, const SurfacePath& path, ToolMotion& motion) {
  const auto target = wanted.inputs(1);
  for (int j = 0; j < kJointCount; ++j)
    for (const double part : kJointParts) {
      const double from = motion.inputs(1)[j], to = from + part * (target[j] - from);
      if (to == from) continue;
      ToolMotion tried = motion;
      tried.moveEnd(j, to);
      if (!isFree(poses, tried, path)) continue;
      motion = tried;
      break;
    }
}

void ToolGuard::findPairs(ToolPoses& poses, const ToolMotion& motion, const SurfacePath& path) {
  motion.linkPoses(1, poses.end);
  tool_.place(poses.start, poses.end);
  near_.find(tool_, path, kKeptThickness * *std::max_element(thickness_.begin(), thickness_.end()), pairs_);
}

bool ToolGuard::isFree(ToolPoses& poses, const ToolMotion& motion, const SurfacePath& path) {
  findPairs(poses, motion, path);
  return std::all_of(pairs_.begin(), pairs_.end(),
                     [&](const NearTriangles::Pair& pair) { return isDrawnIn(pair) || freePart(pair, path) >= 1; });
}

double ToolGuard::freePart(ToolPoses& poses, const ToolMotion& motion, const SurfacePath& path) {
  findPairs(poses, motion, path);
  double part = 1;
  worst_ = -1;
  for (const NearTriangles::Pair& pair : pairs_) {
    const double free = isDrawnIn(pair) ? 1 : freePart(pair, path);
    if (free < part) part = free, worst_ = near_.triangles()[pair.triangle][0];
  }
  return part;
}

bool ToolGuard::isDrawnIn(const NearTriangles::Pair& pair) const {
  if (held_.empty() || on_tip_[pair.shape] == 0) return false;
  const std::array<int, 3>& n = near_.triangles()[pair.triangle];
  return std::any_of(n.begin(), n.end(),
                     [this](int vertex) { return std::find(held_.begin(), held_.end(), vertex) != held_.end(); });
}

double ToolGuard::freePart(const NearTriangles::Pair& pair, const SurfacePath& path) const {
  const std::array<int, 3>& n = near_.triangles()[pair.triangle];
  const double radius = tool_.radius(pair.shape);
  const double thinnest = std::min({thickness_[n[0]], thickness_[n[1]], thickness_[n[2]]});
  const double highest_floor = radius + kKeptThickness * thinnest;
  if (staysApart(tool_, pair.shape, path, n, highest_floor, highest_floor)) return 1;
  const TriangleGap gap = tool_.gap(pair.shape, 0, {path.start(n[0]), path.start(n[1]), path.start(n[2])});
  if (gap.distance == 0) return 1;  // they crossed before
  const double outside = gap.distance - radius, nearer = outside > kLeastThickness * thinnest ? kNearer : kHardlyNearer;
  const double floor =
      outside > 0 ? radius + std::min(kKeptThickness * thinnest, nearer * outside) : kNearer * gap.distance;
  return approach(tool_, pair.shape, path, n, floor, gap).fraction;
}

}  // namespace vibe
