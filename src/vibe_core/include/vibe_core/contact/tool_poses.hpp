#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace vibe {

/// Poses of the tool links in world at the start and at the end of a step, in the link order of Model::tool.
struct ToolPoses {
  std::vector<Eigen::Isometry3d> start, end;
  std::vector<Eigen::Isometry3d> middle;  ///< half way, before the solve; empty: a tool that does not yield
};

}  // namespace vibe
