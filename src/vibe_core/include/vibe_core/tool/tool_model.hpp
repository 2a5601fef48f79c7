#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "vibe_core/input/step_input.hpp"
#include "vibe_core/state/tool_displacement.hpp"

namespace vibe {

/// Most joints of a shaft in one direction.
constexpr int kMaxShaftStations = 16;

/// The bent shaft of a tool as a chain of joints: the part inside the lumen is a beam, clamped where it enters, whose
/// curvature is linear along it (exact for a force and a moment at its end, Euler and Bernoulli). Each joint takes the
/// curvature around it with the weight of a hat function, which leaves the rotation and the deflection of the beam's
/// end exact for small angles, wherever the joints are.
class ShaftBend {
 public:
  /// How the angle of a joint follows from the two amplitudes of its direction, and how these shares change with the
  /// free length.
  struct Share {
    double mean = 0, change = 0;            ///< [m]
    double mean_rate = 0, change_rate = 0;  ///< ratio per metre of free length
  };

  /// @param stations      distance of each joint from the end of the shaft, ascending [m], kMaxShaftStations at most
  /// @param free_length   of the shaft between entry and end; 0 or less: nothing bends [m]
  /// @param displacement  of the tool
  ShaftBend(const std::vector<double>& stations, double free_length, const ToolDisplacement& displacement);

  /// Of the joint at a place of the constructor's `stations`, which is not checked; all 0 if nothing bends.
  const Share& share(int station) const { return shares_[static_cast<std::size_t>(station)]; }
  /// Angle of a joint. @param direction  0: up, 1: left [rad]
  double angle(int station, int direction) const;
  /// Its change with the free length at constant amplitudes [rad/m]
  double angleRate(int station, int direction) const;

 private:
  std::array<Share, kMaxShaftStations> shares_{};
  ToolDisplacement displacement_;
};

}  // namespace vibe

class btConvexShape;

namespace vibe {

/// One joint of the kinematic tree of the tool, as read from the URDF.
struct ToolJoint {
  /// The kinds of URDF joints that a tool can have.
  enum class Type { Fixed, Revolute, Prismatic };
  std::string name;         ///< in the URDF
  Type type = Type::Fixed;  ///< Revolute turns about `axis`, Prismatic shifts along it
  int parent_link = -1;     ///< number of the link that it is fixed to, less than child_link
  int child_link = -1;      ///< number of the link that it carries; every link but the root has one such joint
  Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();  ///< joint frame in the parent link [m]
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();           ///< unit, in the joint frame
  int input = -1;         ///< index of the driving input in StepInput::joints; -1: fixed
  double multiplier = 1;  ///< position = multiplier * input + offset (URDF mimic), a ratio
  double offset = 0;      ///< [m], [rad]
  int station = -1;   ///< index into ToolModel::shaftStations(): a joint of the shaft that bends under load; -1: none
  int direction = 0;  ///< of such a joint: 0: up, 1: left
};

/// A convex collision shape of a link: a capsule, cylinder, sphere or box, as a Bullet shape.
struct ToolShape {
  int link = -1;                                             ///< number of the link that it belongs to
  Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();  ///< shape frame in the link [m]
  /// In the frame of `origin`, capsules and cylinders along its z axis [m]. Copies of the tool share it.
  std::shared_ptr<const btConvexShape> shape;
  double margin = 0;  ///< distance of the surface from the core of the Bullet shape, outwards [m]
};

/// The mesh that the URDF has for the picture of a link; of several the first.
struct LinkMesh {
  int link = -1;                                             ///< number of the link
  Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();  ///< mesh in the link [m]
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();           ///< of the mesh, along its axes (ratio)
  std::string file;                                          ///< or package://NAME/FILE
};

/// Range of one of the seven inputs, from the `limit` of the joint with that name.
struct JointLimits {
  double lower = 0;     ///< [m], [rad]
  double upper = 0;     ///< [m], [rad]
  double velocity = 0;  ///< [m/s], [rad/s]
  double effort = 0;    ///< the hand lets slip above this [N], [N m]
};

/// Share of the range of needle_driver before the needle's point passes the cap, and from which the arm counts as
/// closed. Design choices.
constexpr double kFreeSwing = 0.3, kClosedShare = 0.95;

/// What arm and hook of the needle are to a simulation.
enum class NeedleArm {
  Drawn,  ///< a picture: without collision shapes, and turned as the URDF's mimic elements say
  Body    ///< with the URDF's collision shapes, and turned so that the pin between them stays at both
};

/// How arm and hook turn while needle_driver moves: two bars that are joined by a pin, the arm about its hinge, the
/// hook about the needle's point.
struct NeedleLinkage {
  int arm = -1, hook = -1;          ///< numbers of the links needle_arm and needle_hook
  int arm_pin = -1, hook_pin = -1;  ///< of the links at both sides of the pin
  double lower = 0, upper = 0;      ///< range of needle_driver: open, closed [m]
};

/// Endoscope with suturing device: kinematic tree and collision shapes from one URDF. Constant after loading. Parents
/// have lower link numbers than their children; link 0 is the root ("scope_base").
class ToolModel {
 public:
  /// @param urdf_xml  text of the URDF
  /// @param place     name used in error messages, e.g. the file name
  /// Joints named shaft_up_down_1, shaft_left_right_1, ... are moved by no input: they bend under load, and are 0 with
  /// a tool that is rigid. A URDF without them has a straight shaft.
  /// @param arm       what the needle arm is, in a URDF that has needle_arm_hinge and needle_hook_turn
  /// @throws Error for text that is not a valid URDF, a joint type other than fixed, revolute or prismatic, a moving
  ///         joint that neither is one of kJointNames, nor mimics one, nor is one of the shaft, a missing joint of
  ///         kJointNames, missing limits, a mesh collision shape, or a missing link helix, needle, scope_tip or
  ///         scope_camera_optical.
  static ToolModel fromUrdf(const std::string& urdf_xml, const std::string& place, NeedleArm arm = NeedleArm::Drawn);

  int linkCount() const { return static_cast<int>(link_names_.size()); }  ///< number of links, the root included
  /// In the URDF. @param link  0 to linkCount() - 1, not checked
  const std::string& linkName(int link) const { return link_names_[link]; }
  /// @throws Error if no link has that name
  int linkIndex(const std::string& name) const;
  const std::vector<ToolJoint>& joints() const { return joints_; }  ///< parents first: joint k carries link k + 1
  const std::vector<ToolShape>& shapes() const { return shapes_; }  ///< of all links, in the order of their links
  const std::vector<LinkMesh>& meshes() const { return meshes_; }   ///< of all links, in the order of their links
  /// Of the seven inputs, in the order of Joint.
  const std::array<JointLimits, kJointCount>& limits() const { return limits_; }

  /// Of a needle arm that is a body; empty: there is none, or it is only drawn.
  const std::optional<NeedleLinkage>& needleLinkage() const { return linkage_; }

  /// Pose of every link in the frame of the root link, in link order.
  /// @param inputs  positions of the seven inputs [m], [rad]. They are not clamped.
  void forwardKinematics(const std::array<double, kJointCount>& inputs,
                         std::vector<Eigen::Isometry3d>& link_poses) const;

  /// The same of a tool that is displaced from what its inputs say.
  void forwardKinematics(const std::array<double, kJointCount>& inputs, const ToolDisplacement& displacement,
                         std::vector<Eigen::Isometry3d>& link_poses) const;

  /// Distance of each joint of the shaft from its end, ascending [m]; empty: the shaft is straight.
  const std::vector<double>& shaftStations() const { return shaft_stations_; }
  /// Length of the shaft inside the lumen, behind the bending section, negative while that is still outside.
  /// @param insertion  that the tool really has [m]
  double freeLength(double insertion) const { return insertion + shaft_end_; }
  /// The bend of the shaft at these positions of the inputs.
  ShaftBend shaftBend(const std::array<double, kJointCount>& inputs, const ToolDisplacement& displacement) const;

  /// Computes joint inputs within the limits that bring scope_tip to a target pose in the root frame, starting from
  /// `start`. Uses damped least squares over the first four inputs. Position has weight 1 per metre, the direction of
  /// the x axis of the tip 0.02 per radian. The scope has four degrees of freedom, so a full pose is rarely reachable.
  /// Returns the best inputs found; the remaining inputs are copied from `start`.
  std::array<double, kJointCount> inverseKinematics(const Eigen::Isometry3d& target,
                                                    const std::array<double, kJointCount>& start) const;

 private:
  void setArm(NeedleArm arm);

  std::vector<std::string> link_names_;
  std::optional<NeedleLinkage> linkage_;
  std::vector<ToolJoint> joints_;  // ordered parent first; joint k has child_link k + 1
  std::vector<ToolShape> shapes_;
  std::vector<LinkMesh> meshes_;
  std::array<JointLimits, kJointCount> limits_{};
  std::vector<double> shaft_stations_;
  double shaft_end_ = 0;  // along the axis of the root link at insertion 0 [m]
};

/// Poses of the tool links in world, in the link order of Model::tool, and the place of the joints that they belong to:
/// where the tool stays, or another part of a step has had it there already, they are not computed again.
struct LinkPoses {
  std::vector<Eigen::Isometry3d> poses;      ///< by number of the link [m]
  std::array<double, kJointCount> inputs{};  ///< [m], [rad]
  ToolDisplacement displacement{};           ///< of the tool from `inputs`

  const Eigen::Isometry3d& operator[](std::size_t link) const { return poses[link]; }
  operator const std::vector<Eigen::Isometry3d>&() const { return poses; }
};

/// Of one step.
struct ToolPoses {
  LinkPoses start, end;       ///< at the start and at the end of the step
  bool needle_leads = false;  ///< the needle is on the arm: its point pierces what is in its way
  LinkPoses middle;           ///< half way, before the solve; empty: a tool that does not yield
};

}  // namespace vibe
