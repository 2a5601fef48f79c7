#pragma once
#include <Eigen/Geometry>
#include <map>
#include <optional>
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
  explicit JointTree(const std::string& description);

  /// A frame that stands still in another one.
  void setFixed(const std::string& frame, const std::string& parent, const Eigen::Isometry3d& pose);
  /// @param positions  of the joints with these names [m, rad]; others stay. A joint that mimics another one and has a
  ///                   position of its own follows that, as with robot_state_publisher
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
    std::string name;
    std::string mimicked;           ///< the joint that moves it while it has no position of its own; empty: none
    double factor = 1, offset = 0;  ///< of that joint's position
  };
  std::optional<double> positionOf(const Joint& joint) const;
  std::optional<Eigen::Isometry3d> step(const Joint& joint) const;
  /// The root above a frame, and the pose in it.
  std::optional<std::pair<std::string, Eigen::Isometry3d>> toRoot(std::string frame) const;

  std::map<std::string, Joint> joints_;  // by the frame that they carry
  std::map<std::string, double> positions_;
};

}  // namespace vibe::endoscope
