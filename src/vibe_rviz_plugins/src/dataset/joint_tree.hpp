#pragma once
#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vibe {

/// Poses of the links of a robot from its joints, and of frames that stand still: what robot_state_publisher and tf
/// tell in a running graph, without either.
class JointTree {
 public:
  /// @param description  URDF
  /// @throws std::runtime_error  it cannot be read
  explicit JointTree(const std::string& description);

  /// A frame that stands still in another one.
  void setFixed(const std::string& frame, const std::string& parent, const Eigen::Isometry3d& pose);
  /// @param positions  of the joints with these names [m, rad]; others stay
  void setJoints(const std::vector<std::string>& names, const std::vector<double>& positions);

  /// Pose of a frame in another one; empty if they are not connected, or a joint between them has no position yet.
  std::optional<Eigen::Isometry3d> pose(const std::string& frame, const std::string& in) const;

 private:
  enum class Motion { None, Turn, Slide };
  struct Joint {
    std::string parent;
    Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();
    Motion motion = Motion::None;
    Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
    std::string name;  ///< whose position moves it: its own, or that of the joint it mimics
    double factor = 1, offset = 0;
  };
  std::optional<Eigen::Isometry3d> step(const Joint& joint) const;
  /// The root above a frame, and the pose in it.
  std::optional<std::pair<std::string, Eigen::Isometry3d>> toRoot(std::string frame) const;

  std::map<std::string, Joint> joints_;  // by the frame that they carry
  std::map<std::string, double> positions_;
};

}  // namespace vibe
