#include "trainee/needle_view.hpp"

#include <vector>

#include "procedure/needle.hpp"
#include "procedure/needle_path.hpp"

namespace vibe {

std::optional<NeedleView> lookAtNeedle(const Model& model, const Observation& seen) {
  std::vector<double> x, y, z;
  for (const Eigen::Vector3d& p : seen.wall) x.push_back(p.x()), y.push_back(p.y()), z.push_back(p.z());
  // the path is fixed to the tip, which is seen where it is, also if the scope gives way
  std::vector<Eigen::Isometry3d> poses;
  model.tool->forwardKinematics(seen.joints, poses);
  const auto [begin, end] = needlePath(model, poses);
  const Eigen::Isometry3d from_tip = poses[model.tip_link].inverse();
  const auto inWorld = [&](const Eigen::Vector3d& p) {
    return Eigen::Vector3d(seen.tip + seen.tip_turn * (from_tip * p));
  };
  const SurfaceView wall{model.organ.surface.triangles, x, y, z};
  const DeepestPoint deepest = deepestPoint(wall, inWorld(begin), inWorld(end));
  if (deepest.triangle < 0) return {};
  NeedleView view;
  const auto& corners = model.organ.surface.triangles[deepest.triangle];
  for (int corner : corners) view.thickness += model.organ.thickness[corner] / 3;
  view.depth = deepest.distance + 0.5 * view.thickness;
  view.where = nearestIn(deepest.triangle, deepest.point, model.organ.surface.triangles, seen.wall);
  return view;
}

}  // namespace vibe
