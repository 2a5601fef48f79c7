#pragma once

#include <array>
#include <vector>

#include <Eigen/Dense>

#include "vibe_core/tool/tool_model.hpp"

namespace vibe {

/// The links from the root to scope_tip of a tool that no load bends. Who tries many positions of the joints needs no
/// other links: ToolModel::forwardKinematics() gives the same poses, to the bit, and those of the device beside them.
class TipChain {
 public:
  using Inputs = std::array<double, kJointCount>;

  /// @param tool  outlives this
  explicit TipChain(const ToolModel& tool);

  /// Moves the links to where the joints are at these inputs [m], [rad].
  /// @return pose of scope_tip in the root frame
  const Eigen::Isometry3d& place(const Inputs& inputs);

  int count() const { return static_cast<int>(joints_.size()); }
  /// Joint that carries a link: 0 is nearest to the root, count() - 1 is that of scope_tip.
  const ToolJoint& joint(int link) const { return *joints_[link]; }
  /// Pose of such a link in the root frame, where place() has put it.
  const Eigen::Isometry3d& pose(int link) const { return poses_[link]; }
  const Eigen::Isometry3d& tip() const { return poses_.back(); }

 private:
  void turnAll(const Inputs& inputs);

  std::vector<const ToolJoint*> joints_;   // that carry the links
  std::vector<int> alike_;                 // first link whose joint turns by the same rotation; -1: turns by none
  std::vector<bool> straight_;             // the origin of the joint is not turned, as in most tools
  std::vector<Eigen::Matrix3d> rotation_;  // of those first ones
  std::vector<Eigen::Isometry3d> poses_;
  Inputs placed_at_;  // not a number before the first time
};

}  // namespace vibe
