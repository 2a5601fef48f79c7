#include "tool_contact/tool_guard.hpp"

#include <algorithm>
#include <array>

namespace vibe {

namespace {

// Rounding alone: a distance that is hardly there shrinks by so little.
constexpr double kHardlyNearer = 1 - 1e-6;

}  // namespace

ToolGuard::ToolGuard(const ToolModel& tool, const SurfaceMesh& surface, const std::vector<double>& thickness,
                     const std::vector<char>& passable)
    : policy_(stepPolicy()),
      thickness_(thickness),
      on_tip_(shapesOnTip(tool)),
      tool_(tool),
      near_(surface, passable),
      passage_(tool, thickness) {}

double ToolGuard::separate(ToolPoses& poses, ToolMotion& motion, const SurfacePath& path,
                           const std::vector<int>& held) {
  held_ = held;
  double free = freePart(poses, motion, path);
  if (free == 1) return 1;
  const ToolMotion wanted = motion;
  // A tool that goes less far may meet other triangles, because it turns on its way: it is looked at anew, and in the
  // end stays where it was. What is not free even then is the wall's own motion.
  for (int stop = 1; free < 1 && stop <= policy_.guard_attempts; ++stop) {
    motion.stop(stop < policy_.guard_attempts ? policy_.guard_taken * free : 0);
    free = freePart(poses, motion, path);
  }
  // Joints are tried against what the wall goes, not against all of its way, which none of them could bear.
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
  motion.stop(policy_.guard_taken * free);
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

// Each joint in turn goes on where its own motion is free: the tool slides along the wall, or comes off it.
void ToolGuard::moveJoints(ToolPoses& poses, const ToolMotion& wanted, const SurfacePath& path, ToolMotion& motion) {
  const auto target = wanted.inputs(1);
  for (int j = 0; j < kJointCount; ++j)
    for (const double part : {1.0, policy_.guard_joint_part}) {
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
  near_.find(tool_, path, policy_.guard_kept * *std::max_element(thickness_.begin(), thickness_.end()), pairs_);
  passage_.open(poses.start, poses.needle_leads, tool_, path, near_.triangles(), pairs_);
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

// The helix draws what it holds into the device, so that this is no obstacle for what sits on the tip.
bool ToolGuard::isDrawnIn(const NearTriangles::Pair& pair) const {
  if (held_.empty() || on_tip_[pair.shape] == 0) return false;
  const std::array<int, 3>& n = near_.triangles()[pair.triangle];
  return std::any_of(n.begin(), n.end(),
                     [this](int vertex) { return std::find(held_.begin(), held_.end(), vertex) != held_.end(); });
}

// The part of the step up to which one shape and one triangle keep the floor of the equation in the header.
double ToolGuard::freePart(const NearTriangles::Pair& pair, const SurfacePath& path) const {
  const std::array<int, 3>& n = near_.triangles()[pair.triangle];
  const double radius = tool_.radius(pair.shape);
  const double thinnest = std::min({thickness_[n[0]], thickness_[n[1]], thickness_[n[2]]});
  const double highest_floor = radius + policy_.guard_kept * thinnest;
  // Most pairs never come near the floor, whatever their distance at the start.
  if (staysApart(tool_, pair.shape, path, n, highest_floor, highest_floor)) return 1;
  const TriangleGap gap = tool_.gap(pair.shape, 0, {path.start(n[0]), path.start(n[1]), path.start(n[2])});
  if (gap.distance == 0) return 1;  // they crossed before
  // Inside the radius, which a shape is grown by, the core still counts.
  const double outside = gap.distance - radius, kept = policy_.guard_kept * thinnest;
  const double nearer = outside > policy_.guard_least * thinnest ? policy_.guard_nearer : kHardlyNearer;
  const double floor = outside > 0 ? radius + std::min(kept, nearer * outside) : policy_.guard_nearer * gap.distance;
  return approach(tool_, pair.shape, path, n, floor, gap).fraction;
}

}  // namespace vibe
