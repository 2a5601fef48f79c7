#pragma once

#include <array>
#include <vector>

#include <Eigen/Geometry>

#include "vibe_core/solver/body_loads.hpp"
#include "vibe_core/tool/tool_model.hpp"

namespace vibe {

/// Path of the tool during one step: every input, and the displacement of a compliant tool, moves at constant
/// speed from its start to its end value.
class ToolMotion {
 public:
  /// @param base          pose of the tool's root link in world
  /// @param displacement  of the tool at the start; at the end as well, until displaceEnd() says otherwise
  ToolMotion(const ToolModel& tool, const Eigen::Isometry3d& base, const std::array<double, kJointCount>& start,
             const std::array<double, kJointCount>& end, const ToolDisplacement& displacement = {})
      : tool_(&tool),
        base_(base),
        start_(start),
        end_(end),
        start_displacement_(displacement),
        end_displacement_(displacement) {}

  void displaceEnd(const ToolDisplacement& displacement) { end_displacement_ = displacement; }
  /// The motion ends at a fraction [0, 1] of the way.
  void stop(double fraction);
  /// One input ends elsewhere.
  void moveEnd(int input, double position) { end_[static_cast<std::size_t>(input)] = position; }
  const ToolDisplacement& startDisplacement() const { return start_displacement_; }

  /// Pose of every link in world at a fraction [0, 1] of the step.
  /// @param at  in and out; of this tool on this base, or empty
  void linkPoses(double fraction, LinkPoses& at) const;

  /// The inputs at a fraction [0, 1] of the step [m], [rad].
  std::array<double, kJointCount> inputs(double fraction) const;

  /// The displacement at a fraction [0, 1] of the step.
  ToolDisplacement displacement(double fraction) const;

  /// An upper bound of the displacement of any point of a collision shape between two sets of link poses [m].
  double travel(const std::vector<Eigen::Isometry3d>& from, const std::vector<Eigen::Isometry3d>& to) const;

 private:
  const ToolModel* tool_;
  Eigen::Isometry3d base_;
  std::array<double, kJointCount> start_, end_;
  ToolDisplacement start_displacement_, end_displacement_;
};

/// Derivative of the position of a point on a link with respect to the tool inputs: columns in the order of vibe::Joint
/// [m/m], [m/rad].
/// @param poses  of the links in any one frame, as from ToolModel::forwardKinematics(); the result is in that frame
/// @param point  in the same frame [m]
Eigen::Matrix<double, 3, kJointCount> pointJacobian(const ToolModel& tool, const std::vector<Eigen::Isometry3d>& poses,
                                                    int link, const Eigen::Vector3d& point);

/// Derivative of the position of a point on a link with respect to the tool's displacement: columns in the order of
/// ToolDisplacement [m/m], [m/rad], [m^2]. The first counts that the free length of a bent shaft changes.
/// @param bend  of the shaft, ToolModel::shaftBend()
Eigen::Matrix<double, 3, kYieldDofs> yieldJacobian(const ToolModel& tool, const std::vector<Eigen::Isometry3d>& poses,
                                                   const ShaftBend& bend, int link, const Eigen::Vector3d& point);

}  // namespace vibe
