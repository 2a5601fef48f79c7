#pragma once
#include <urdf/model.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace vibe::endoscope {

/// Poses of the links of a robot from its joints, and of frames that stand still: what robot_state_publisher and tf
/// tell in a running graph, without either.
class JointTree {
 public:
  /// @param description  URDF
  /// @throws std::runtime_error  it cannot be read
  explicit JointTree(const std::string& description) {
    urdf::Model model;
    if (!model.initString(description))
      throw std::runtime_error("The URDF of the recording cannot be read, so nothing tells where the camera is.");
    for (const auto& [name, from] : model.joints_) {
      Joint& joint = joints_[from->child_link_name];
      joint.parent = from->parent_link_name;
      const urdf::Pose& origin = from->parent_to_joint_origin_transform;
      double x, y, z, w;
      origin.rotation.getQuaternion(x, y, z, w);
      joint.origin = Eigen::Translation3d(origin.position.x, origin.position.y, origin.position.z) *
                     Eigen::Isometry3d(Eigen::Quaterniond(w, x, y, z).normalized());
      joint.name = name;
      if (from->mimic) {
        joint.mimicked = from->mimic->joint_name;
        joint.factor = from->mimic->multiplier, joint.offset = from->mimic->offset;
      }
      joint.axis = Eigen::Vector3d(from->axis.x, from->axis.y, from->axis.z);
      if (from->type == urdf::Joint::REVOLUTE || from->type == urdf::Joint::CONTINUOUS) joint.motion = Motion::Turn;
      if (from->type == urdf::Joint::PRISMATIC) joint.motion = Motion::Slide;
      if (joint.motion != Motion::None) joint.axis.normalize();
    }
  }

  /// A frame that stands still in another one.
  void setFixed(const std::string& frame, const std::string& parent, const Eigen::Isometry3d& pose) {
    Joint& joint = joints_[frame];
    joint = Joint();
    joint.parent = parent, joint.origin = pose;
  }

  /// @param positions  of the joints with these names [m, rad]; others stay. A joint that mimics another one and has a
  ///                   position of its own follows that, as with robot_state_publisher
  void setJoints(const std::vector<std::string>& names, const std::vector<double>& positions) {
    for (std::size_t k = 0; k < std::min(names.size(), positions.size()); ++k) positions_[names[k]] = positions[k];
  }

  /// Pose of a frame in another one; empty if they are not connected, or a joint between them has no position yet.
  std::optional<Eigen::Isometry3d> pose(const std::string& frame, const std::string& in) const {
    const auto a = toRoot(frame), b = toRoot(in);
    if (!a || !b || a->first != b->first) return std::nullopt;
    return b->second.inverse() * a->second;
  }

 private:
  enum class Motion { None, Turn, Slide };
  struct Joint {
    std::string parent;
    Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();
    Motion motion = Motion::None;
    Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
    std::string name;
    std::string mimicked;           ///< the joint that moves it while it has no position of its own; empty: none
    double factor = 1, offset = 0;  ///< of that joint's position
  };

  std::optional<double> positionOf(const Joint& joint) const {
    if (const auto own = positions_.find(joint.name); own != positions_.end()) return own->second;
    const auto source = positions_.find(joint.mimicked);
    if (source == positions_.end()) return std::nullopt;
    return joint.factor * source->second + joint.offset;
  }

  std::optional<Eigen::Isometry3d> step(const Joint& joint) const {
    if (joint.motion == Motion::None) return joint.origin;
    const std::optional<double> position = positionOf(joint);
    if (!position) return std::nullopt;
    if (joint.motion == Motion::Slide) return joint.origin * Eigen::Translation3d(*position * joint.axis);
    return joint.origin * Eigen::Isometry3d(Eigen::AngleAxisd(*position, joint.axis));
  }

  /// The root above a frame, and the pose in it.
  std::optional<std::pair<std::string, Eigen::Isometry3d>> toRoot(std::string frame) const {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    for (std::size_t depth = 0; depth <= joints_.size(); ++depth) {
      const auto joint = joints_.find(frame);
      if (joint == joints_.end()) return std::pair(frame, pose);
      const std::optional<Eigen::Isometry3d> above = step(joint->second);
      if (!above) return std::nullopt;
      pose = *above * pose;
      frame = joint->second.parent;
    }
    return std::nullopt;  // a circle
  }

  std::map<std::string, Joint> joints_;  // by the frame that they carry
  std::map<std::string, double> positions_;
};

}  // namespace vibe::endoscope
