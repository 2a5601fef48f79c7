#pragma once
#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "vibe_core/input/step_input.hpp"

class btConvexShape;

namespace vibe {

/// One joint of the tool's tree as read from the URDF.
struct ToolJoint {
  enum class Type { Fixed, Revolute, Prismatic };
  std::string name;
  Type type = Type::Fixed;
  int parent_link = -1;
  int child_link = -1;
  Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();  ///< joint frame in the parent link
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();           ///< unit, in the joint frame
  int input = -1;                                            ///< index into StepInput::joints that drives it; -1: fixed
  double multiplier = 1;                                     ///< position = multiplier * input + offset (URDF mimic)
  double offset = 0;                                         ///< [m], [rad]
};

/// A convex collision shape of a link; capsules, cylinders, spheres and boxes as Bullet shapes.
struct ToolShape {
  int link = -1;
  Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();  ///< shape frame in the link
  std::shared_ptr<const btConvexShape> shape;
  double margin = 0;  ///< the surface lies this far outside of the Bullet shape's core [m]
};

/// Range of one of the seven inputs, from the <limit> of the joint of that name.
struct JointLimits {
  double lower = 0;     ///< [m], [rad]
  double upper = 0;     ///< [m], [rad]
  double velocity = 0;  ///< [m/s], [rad/s]
};

/// Endoscope with suturing device: kinematic tree and collision shapes from one URDF. Constant after loading.
/// Links are numbered so that a parent comes before its children; link 0 is the root ("scope_base").
class ToolModel {
 public:
  /// @param urdf_xml  the URDF's text
  /// @param place     what to call it in errors, e.g. the file name
  /// @throws Error for XML that is no URDF, a joint type other than fixed / revolute / prismatic, a moving joint
  ///         that neither is one of kJointNames nor mimics one, a missing one of kJointNames, missing limits,
  ///         a mesh collision shape, or links helix, needle, scope_tip, scope_camera_optical missing.
  static ToolModel fromUrdf(const std::string& urdf_xml, const std::string& place);

  int linkCount() const { return static_cast<int>(link_names_.size()); }
  const std::string& linkName(int link) const { return link_names_[link]; }
  /// @throws Error if there is no link of that name
  int linkIndex(const std::string& name) const;
  const std::vector<ToolJoint>& joints() const { return joints_; }
  const std::vector<ToolShape>& shapes() const { return shapes_; }
  const std::array<JointLimits, kJointCount>& limits() const { return limits_; }

  /// Pose of every link in the root link's frame, in link order.
  /// @param inputs  positions of the seven inputs [m], [rad]; used as they are (clamp before)
  void forwardKinematics(const std::array<double, kJointCount>& inputs,
                         std::vector<Eigen::Isometry3d>& link_poses) const;

  /// Joint inputs that bring scope_tip to a target pose in the root frame, nearest to `start`, within the limits:
  /// damped least squares over the first four inputs; position weighs 1 per metre and the direction of the tip's
  /// x axis 0.02 per radian (the scope has four degrees of freedom, so a full pose is rarely reachable).
  /// Returns the best inputs found, the rest copied from `start`.
  std::array<double, kJointCount> inverseKinematics(const Eigen::Isometry3d& target,
                                                    const std::array<double, kJointCount>& start) const;

 private:
  std::vector<std::string> link_names_;
  std::vector<ToolJoint> joints_;  // ordered parent first; joint k has child_link k + 1
  std::vector<ToolShape> shapes_;
  std::array<JointLimits, kJointCount> limits_{};
};

}  // namespace vibe
