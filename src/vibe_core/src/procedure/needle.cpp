#include "procedure/needle.hpp"

#include <algorithm>
#include <cmath>

namespace vibe {

namespace {

constexpr double kFreeSwing = 0.3;  // share of the chord before the needle's point passes the cap [1]
constexpr double kMaxDepth = 0.01;  // half of the width of the curved needle, which reaches no deeper [m]

// Particles within the radius that are connected to the triangle, found by region growing over triangles.
std::vector<int> connectedWithin(const SurfaceView& wall, int triangle, const Eigen::Vector3d& point, double radius) {
  const auto isNear = [&](int v) { return (wall.position(v) - point).norm() < radius; };
  std::vector<int> near;  // triangles that have a corner within the radius
  for (int t = 0; t < static_cast<int>(wall.triangles.size()); ++t) {
    const auto& corners = wall.triangles[t];
    if (std::any_of(corners.begin(), corners.end(), isNear)) near.push_back(t);
  }
  std::vector<int> found(wall.triangles[triangle].begin(), wall.triangles[triangle].end());
  const auto isFound = [&](int v) { return std::find(found.begin(), found.end(), v) != found.end(); };
  for (bool grown = true; grown;) {
    grown = false;
    for (int t : near) {
      const auto& corners = wall.triangles[t];
      if (std::none_of(corners.begin(), corners.end(), isFound)) continue;
      for (int v : corners) {
        if (isFound(v) || !isNear(v)) continue;
        found.push_back(v);
        grown = true;
      }
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

double thicknessAround(const Model& model, const Bite& bite) {
  double sum = 0;
  for (std::size_t k = 0; k < bite.particle.size(); ++k)
    sum += bite.weight[k] * model.organ.thickness[bite.particle[k]];
  return sum;
}

}  // namespace

int nearestParticle(const Bite& bite) {
  if (bite.particle.empty()) return -1;
  return bite.particle[std::max_element(bite.weight.begin(), bite.weight.end()) - bite.weight.begin()];
}

std::pair<Eigen::Vector3d, Eigen::Vector3d> needlePath(const Model& model,
                                                       const std::vector<Eigen::Isometry3d>& link_poses) {
  const ToolJoint& joint = model.tool->joints()[static_cast<std::size_t>(model.needle_link) - 1];
  const JointLimits& limits = model.tool->limits()[NeedleDriver];
  const auto pointAt = [&](double input) -> Eigen::Vector3d {
    const Eigen::Vector3d along = joint.axis * (joint.multiplier * input + joint.offset);
    return link_poses[joint.parent_link] * (joint.origin * along);
  };
  return {pointAt(limits.lower + kFreeSwing * (limits.upper - limits.lower)), pointAt(limits.upper)};
}

Bite biteAround(const Model& model, const SurfaceView& wall, int triangle, const Eigen::Vector3d& point,
                double radius) {
  double reach = radius;
  for (int v : wall.triangles[triangle]) reach = std::max(reach, 1.5 * (wall.position(v) - point).norm());
  Bite bite;
  bite.particle = connectedWithin(wall, triangle, point, reach);
  double sum = 0;
  for (int v : bite.particle) {
    const double ratio = (wall.position(v) - point).norm() / reach;
    const double fall = 1 - ratio * ratio;
    bite.weight.push_back(model.area[v] * fall * fall);
    sum += bite.weight.back();
  }
  for (double& weight : bite.weight) weight /= sum;
  const int nearest = nearestParticle(bite);
  bite.thickness = thicknessAround(model, bite);
  bite.region = model.organ.region[nearest];
  bite.wall = model.organ.wall[nearest];
  for (std::size_t k = 0; k < bite.particle.size() && !model.along.empty(); ++k)
    bite.along += bite.weight[k] * model.along[bite.particle[k]];
  return bite;
}

NeedleReach reachOfNeedle(const Model& model, const State& state, const Eigen::Vector3d& begin,
                          const Eigen::Vector3d& end) {
  const SurfaceView wall{model.organ.surface.triangles, state.x, state.y, state.z};
  const DeepestPoint deepest = deepestPoint(wall, begin, end);
  NeedleReach reach;
  reach.depth = -1;  // a gap of one metre if no triangle of the wall has finite positions
  if (deepest.triangle < 0) return reach;
  Bite bite = biteAround(model, wall, deepest.triangle, deepest.point, model.scene.suture->bite_radius);
  reach.depth = std::min(deepest.distance + 0.5 * bite.thickness, kMaxDepth);
  if (reach.depth <= 0) return reach;
  bite.depth = reach.depth;
  bite.time = state.time;
  reach.bite = std::move(bite);
  return reach;
}

}  // namespace vibe
