#include "vibe_core/simulation/wall_coverage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "arithmetic/elementary.hpp"
#include "geometry/ray.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/geometry/mesh_file.hpp"
#include "vibe_core/simulation/tool_queries.hpp"

namespace vibe {

namespace {

void append(const SurfaceMesh& mesh, const Eigen::Affine3d& pose, SurfaceMesh& all) {
  const int first = static_cast<int>(all.vertices.size());
  for (const Eigen::Vector3d& vertex : mesh.vertices) all.vertices.push_back(pose * vertex);
  for (const auto& t : mesh.triangles) all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

// In scope_tip.
SurfaceMesh deviceBefore(const Model& model) {
  std::vector<char> carried(static_cast<std::size_t>(model.tool->linkCount()));
  for (const ToolJoint& joint : model.tool->joints())
    carried[joint.child_link] = carried[joint.parent_link] != 0 || joint.parent_link == model.tip_link ? 1 : 0;
  const std::vector<Eigen::Isometry3d> poses = drawnLinkPoses(model, State{});  // all joints at 0
  const Eigen::Isometry3d to_tip = poses[model.tip_link].inverse();
  SurfaceMesh device;
  for (const LinkMesh& mesh : model.tool->meshes())
    if (carried[mesh.link] != 0)
      append(readMeshFile(resolveAddress(mesh.file)),
             to_tip * poses[mesh.link] * mesh.origin * Eigen::Scaling(mesh.scale), device);
  return device;
}

Eigen::Isometry3d lensInTip(const Model& model) {
  std::vector<Eigen::Isometry3d> poses;
  model.tool->forwardKinematics({}, poses);
  return poses[model.tip_link].inverse() * poses[model.tool->linkIndex("scope_camera_optical")];
}

// Of the vertices, outwards: sums of the areas of their triangles.
void findNormals(const SurfaceView& wall, std::vector<Eigen::Vector3d>& normal) {
  std::fill(normal.begin(), normal.end(), Eigen::Vector3d::Zero());
  for (const auto& triangle : wall.triangles) {
    const Eigen::Vector3d area = areaVector(wall, triangle);
    for (const int corner : triangle) normal[corner] += area;
  }
}

}  // namespace

InspectionLens::InspectionLens(const Model& model, const InspectionScene& inspection)
    : inspection_(inspection),
      least_ahead_(math::cos(inspection.field_of_view / 2)),
      least_facing_(math::cos(inspection.angle)),
      clear_(model.particle_radius),
      lens_in_tip_(lensInTip(model)),
      device_(deviceBefore(model)),
      wall_(model.organ.surface),
      normal_(model.organ.surface.vertices.size()) {
  seen_.reserve(normal_.size());
}

bool InspectionLens::isOf(const InspectionScene& other) const {
  return inspection_.field_of_view == other.field_of_view && inspection_.distance == other.distance &&
         inspection_.angle == other.angle;
}

bool InspectionLens::isInPicture(const Eigen::Vector3d& way, const Eigen::Vector3d& axis,
                                 const Eigen::Vector3d& outward) const {
  const double distance = way.norm();
  return distance <= inspection_.distance && way.dot(axis) >= least_ahead_ * distance &&
         way.dot(outward) >= least_facing_ * distance * outward.norm();
}

const std::vector<int>& InspectionLens::look(const Eigen::Isometry3d& tip, const SurfaceView& wall,
                                             const std::vector<char>& leave_out) {
  seen_.clear();
  const Eigen::Vector3d lens = tip * lens_in_tip_.translation(), axis = (tip * lens_in_tip_).linear().col(2);
  const Eigen::Isometry3d to_tip = tip.inverse();
  findNormals(wall, normal_);
  bool moved = false;  // the tree, which nobody needs who has seen all that is before the lens
  for (std::size_t i = 0; i < normal_.size(); ++i) {
    if (leave_out[i] != 0) continue;
    const Eigen::Vector3d place = wall.position(static_cast<int>(i)), way = place - lens;
    if (!isInPicture(way, axis, normal_[i])) continue;
    if (!moved) wall_.moveTo(wall.x, wall.y, wall.z), moved = true;
    const double distance = way.norm();
    if (distance > clear_ && wall_.isBetween(lens, lens + (1 - clear_ / distance) * way)) continue;
    if (!device_.isBetween(lens_in_tip_.translation(), to_tip * place)) seen_.push_back(static_cast<int>(i));
  }
  return seen_;
}

WallCoverage::WallCoverage(const Model& model, const InspectionScene& inspection)
    : model_(&model), lens_(model, inspection) {
  forget();
}

void WallCoverage::forget() {
  const std::vector<End>& end = model_->organ.end;
  leave_out_.assign(end.size(), 0);
  std::transform(end.begin(), end.end(), leave_out_.begin(), [](End one) { return one == End::None ? 0 : 1; });
  first_seen_.assign(end.size(), std::numeric_limits<float>::quiet_NaN());
}

bool WallCoverage::isDue(std::int64_t step, double step_period) {
  return step % std::max(1L, std::lround(kPeriod / step_period)) == 0;
}

void WallCoverage::look(const Eigen::Isometry3d& tip, const SurfaceView& wall, double time) {
  for (const int i : lens_.look(tip, wall, leave_out_)) {
    leave_out_[i] = 1;
    first_seen_[i] = static_cast<float>(time);
  }
}

namespace {

/// An area and what of it has been seen [m^2].
struct Part {
  double all = 0, seen = 0;

  void add(double area, bool is_seen) { all += area, seen += is_seen ? area : 0; }
  std::optional<double> share() const { return all > 0 ? std::optional<double>(seen / all) : std::nullopt; }
};

}  // namespace

CoverageSkill WallCoverage::shares() const {
  const Organ& organ = model_->organ;
  Part whole;
  std::array<Part, kRegionCount> region;
  std::array<Part, kWallCount> wall;
  for (std::size_t i = 0; i < first_seen_.size(); ++i) {
    if (organ.end[i] != End::None) continue;
    const bool is_seen = !std::isnan(first_seen_[i]);
    for (Part* part :
         {&whole, &region[static_cast<std::size_t>(organ.region[i])], &wall[static_cast<std::size_t>(organ.wall[i])]})
      part->add(model_->area[i], is_seen);
  }
  CoverageSkill skill;
  skill.whole = whole.share();
  std::transform(region.begin(), region.end(), skill.region.begin(), [](const Part& part) { return part.share(); });
  std::transform(wall.begin(), wall.end(), skill.wall.begin(), [](const Part& part) { return part.share(); });
  return skill;
}

}  // namespace vibe
