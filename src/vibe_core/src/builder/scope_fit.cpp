#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <BulletCollision/CollisionShapes/btConvexShape.h>
#include <Eigen/Geometry>

#include "arithmetic/turn.hpp"
#include "constraints/supports.hpp"
#include "vibe_core/builder/scope_fit.hpp"
#include "vibe_core/files/number_text.hpp"

namespace vibe {

namespace {

// How far an open end that is held stretches around a scope. Measured with young_modulus 110 kPa: 1.55 passes with 12
// N, 1.66 does not at 20 N (3,618 particles); 1.76 passes with 20 N, 1.97 does not (2,000).
constexpr double kWidestStretch = 1.6;
constexpr int kOutwards = 64;  // around the axis

/// A circle with the area of the open end, seen along the entry, and the wall around it.
struct OpenEnd {
  double radius = 0;     ///< of the mid-surface [m]; 0: there is none
  double thickness = 0;  ///< of the wall [m]
};

OpenEnd openEnd(const Organ& organ) {
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  double thickness = 0;
  int corners = 0;
  for (const std::array<int, 3>& n : organ.surface.triangles) {
    if (std::none_of(n.begin(), n.end(), [&](int v) { return organ.end[v] == End::Oesophagus; })) continue;
    const Eigen::Vector3d& corner = organ.surface.vertices[n[0]];
    area += 0.5 * (organ.surface.vertices[n[1]] - corner).cross(organ.surface.vertices[n[2]] - corner);
    for (const int v : n) thickness += organ.thickness[v], ++corners;
  }
  if (corners == 0) return {};
  return {std::sqrt(std::abs(area.dot(organ.entry_axis)) / M_PI), thickness / corners};
}

/// How far a shape reaches from the x axis of the frame in which its pose is [m].
double reachFromAxis(const ToolShape& shape, const Eigen::Isometry3d& pose) {
  double reach = 0;
  for (int k = 0; k < kOutwards; ++k) {
    const Eigen::Vector3d out =
        rotationAbout(Eigen::Vector3d::UnitX(), 2 * M_PI * k / kOutwards) * Eigen::Vector3d::UnitY();
    const Eigen::Matrix<btScalar, 3, 1> local = (pose.linear().transpose() * out).cast<btScalar>();
    const btVector3 far = shape.shape->localGetSupportingVertex({local.x(), local.y(), local.z()});
    reach = std::max(reach, out.dot(pose * Eigen::Vector3d(far.x(), far.y(), far.z())));
  }
  return reach;
}

/// The widest link of a tool, and how far it reaches from the axis [m].
std::pair<int, double> widestLink(const ToolModel& tool) {
  std::vector<Eigen::Isometry3d> poses;
  tool.forwardKinematics({}, poses);
  std::pair<int, double> widest{0, 0};
  for (const ToolShape& shape : tool.shapes()) {
    const auto& arm = tool.needleLinkage();
    if (arm && (shape.link == arm->arm || shape.link == arm->hook)) continue;  // an arm that is thin gives room
    const double reach = reachFromAxis(shape, poses[static_cast<std::size_t>(shape.link)] * shape.origin);
    if (reach > widest.second) widest = {shape.link, reach};
  }
  return widest;
}

std::string inMillimetres(double length) {
  return formatted("%.1f mm", 1e3 * length);
}

}  // namespace

std::string fitWarning(const Model& model) {
  if (!model.tool || !model.scene.scope->base_from_anatomy || !isHeld(model.scene, End::Oesophagus)) return "";
  const OpenEnd end = openEnd(model.organ);
  const auto [link, reach] = widestLink(*model.tool);
  const double passes = kWidestStretch * end.radius - 0.5 * end.thickness;
  if (end.radius == 0 || reach <= passes) return "";
  const bool mesh = model.scene.geometry.kind == GeometryScene::Kind::Mesh;
  return "The scope may be too wide for the open end of the organ: link '" + model.tool->linkName(link) + "' of " +
         model.scene.scope->urdf + " is " + inMillimetres(2 * reach) + " wide, the end at the oesophagus " +
         inMillimetres(2 * end.radius - end.thickness) + ", and about " + inMillimetres(2 * passes) +
         " pass as it stretches; make the collision shapes of the URDF narrower" +
         (mesh ? ", or the surface wider there (geometry.unit, geometry.target_volume)." : ".");
}

}  // namespace vibe
