#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "tool_contact/near_triangles.hpp"
#include "tool_contact/tool_approach.hpp"
#include "vibe_core/tool/tool_model.hpp"

namespace vibe {

/// Where a needle arm that is a body passes through the wall. It does so in two places only, around which the triangles
/// that share a vertex are no obstacle for arm and hook:
///   ahead    the needle is on the arm and past its free swing: triangles that the rest of its way crosses, or comes
///            nearer to than half the wall, which is where a bite is found (reachOfNeedle())
///   behind   triangles that the core of arm or hook crosses already: what was pierced goes with them until they are
///   out
/// Nothing is remembered for that. A closed arm lies before the face of the endoscope and has no contact.
class NeedlePassage {
 public:
  /// @param tool       must outlive this object
  /// @param thickness  of the wall per vertex [m]
  NeedlePassage(const ToolModel& tool, const std::vector<double>& thickness);

  /// Removes the pairs of arm and hook that are no obstacle.
  /// @param poses      of every link in world at the start of the step
  /// @param leads      the needle is on the arm
  /// @param shapes     the tool along the step, which begins at `poses`
  /// @param triangles  of which the pairs have the numbers
  /// @param near       pairs that may meet in the step
  void open(const std::vector<Eigen::Isometry3d>& poses, bool leads, const SweptTool& shapes, const SurfacePath& path,
            const std::vector<std::array<int, 3>>& triangles, std::vector<NearTriangles::Pair>& near);
  /// Whether a shape is part of an arm that was closed at the last open().
  bool isAway(int shape) const { return closed_ && of_arm_[shape] != 0; }

 private:
  double driver(const std::vector<Eigen::Isometry3d>& poses) const;
  bool isOpening(const SweptTool& shapes, const NearTriangles::Pair& pair, const SurfacePath& path,
                 const std::array<int, 3>& triangle) const;

  const ToolModel& tool_;
  std::vector<char> of_arm_;       // per shape; empty: there is no such arm
  std::vector<double> thickness_;  // [m]
  bool closed_ = false, bites_ = false;
  std::array<Eigen::Vector3d, 2> way_;  // of the needle's point until the arm is closed, while it bites [m]
  std::vector<char> open_;              // per vertex
};

}  // namespace vibe
