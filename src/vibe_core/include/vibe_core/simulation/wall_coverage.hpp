#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "vibe_core/geometry/triangle_tree.hpp"
#include "vibe_core/metrics/coverage_skill.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/scene/scene.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// Which particles of the wall the lens of the endoscope sees. A particle is seen that lies
///   - within half of InspectionScene::field_of_view from the optical axis, whatever the projection of the lens,
///   - no farther than InspectionScene::distance from the lens,
///   - on a wall that turns its inside to the lens, its normal (the mean of its triangles, weighted with their areas)
///     no more than InspectionScene::angle from the line of sight, and
///   - behind nothing: the line of sight meets no triangle of the wall before half a wall's thickness from the
///     particle, and no mesh that the URDF has for what scope_tip carries. The device is taken as it is at the start,
///     with its arm open and its helix drawn in.
/// Blood, threads and smoke hide nothing.
class InspectionLens {
 public:
  /// Reads the meshes of the device.
  /// @param model  with a tool; must outlive this
  /// @throws Error if a mesh cannot be read
  InspectionLens(const Model& model, const InspectionScene& inspection);

  /// @param tip        pose of scope_tip in world
  /// @param wall       positions of the particles, in world [m]
  /// @param leave_out  (particles); not 0: it is not looked for
  /// @return numbers of the particles that are seen, ascending; valid until the next call
  const std::vector<int>& look(const Eigen::Isometry3d& tip, const SurfaceView& wall,
                               const std::vector<char>& leave_out);
  /// Whether it was made for these limits.
  bool isOf(const InspectionScene& inspection) const;

 private:
  bool isInPicture(const Eigen::Vector3d& way, const Eigen::Vector3d& axis, const Eigen::Vector3d& outward) const;

  InspectionScene inspection_;
  double least_ahead_, least_facing_;  // cosines
  double clear_;                       // of the wall around a particle [m]
  Eigen::Isometry3d lens_in_tip_;
  TriangleTree device_;  // in scope_tip
  TriangleTree wall_;
  std::vector<Eigen::Vector3d> normal_;  // (particles), any length
  std::vector<int> seen_;
};

/// What the lens has seen of the wall since it was made or forgot.
class WallCoverage {
 public:
  /// From look to look, or a step, if that is longer; design choice [s]
  static constexpr double kPeriod = 0.1;

  /// As InspectionLens.
  WallCoverage(const Model& model, const InspectionScene& inspection);

  /// Whether a look belongs to the present step: a function of the number of the step alone, so that a replay that
  /// begins later looks at the same times.
  static bool isDue(std::int64_t step, double step_period);

  /// @param time  of the look [s]
  void look(const Eigen::Isometry3d& tip, const SurfaceView& wall, double time);
  /// Nothing has been seen.
  void forget();

  /// Time at which each particle was seen first; not a number: not yet, or it belongs to an end. (particles) [s]
  const std::vector<float>& firstSeen() const { return first_seen_; }
  /// Areas are those at rest. The ends, through which the organ goes on, do not count.
  CoverageSkill shares() const;

 private:
  const Model* model_;
  InspectionLens lens_;
  std::vector<char> leave_out_;
  std::vector<float> first_seen_;
};

}  // namespace vibe
