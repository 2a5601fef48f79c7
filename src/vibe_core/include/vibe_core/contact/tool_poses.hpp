#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "vibe_core/input/step_input.hpp"
#include "vibe_core/state/tool_displacement.hpp"

namespace vibe {

/// Poses of the tool links in world, in the link order of Model::tool, and the place of the joints that they belong to:
/// where the tool stays, or another part of a step has had it there already, they are not computed again.
struct LinkPoses {
  std::vector<Eigen::Isometry3d> poses;
  std::array<double, kJointCount> inputs{};  ///< [m], [rad]
  ToolDisplacement displacement{};

  const Eigen::Isometry3d& operator[](std::size_t link) const { return poses[link]; }
  operator const std::vector<Eigen::Isometry3d>&() const { return poses; }
};

/// Of one step.
struct ToolPoses {
  LinkPoses start, end;
  LinkPoses middle;  ///< half way, before the solve; empty: a tool that does not yield
};

}  // namespace vibe
