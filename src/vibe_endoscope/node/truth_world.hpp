#pragma once
#include <sensor_msgs/PointCloud2.h>
#include <vibe_msgs/SutureArray.h>
#include <vibe_msgs/TissueTopology.h>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "robot_shapes.hpp"
#include "truth/truth_scene.hpp"
#include "vibe_graphics/geometry/tissue_mesh.hpp"
#include "vibe_graphics/messages/suture_messages.hpp"
#include "vibe_graphics/messages/tissue_messages.hpp"

namespace vibe::endoscope {

/// The scene of the truth from the messages that the endoscope's image is drawn from. Its frame is that of the
/// particles. Functions that take a message return one sentence if it is wrong, and the scene stays as it is.
class TruthWorld {
 public:
  /// Pose of a frame in the frame of the scene at the time that is looked at.
  using PoseOf = std::function<std::optional<Eigen::Isometry3d>(const std::string& frame)>;

  /// @param description  URDF of the instrument
  /// @throws std::runtime_error  Embree cannot be used, or the instrument has more parts than there are labels
  explicit TruthWorld(const std::string& description) {
    for (RobotShape& part : robotShapes(description, problems_))
      parts_.push_back({part.frame, scene_.addPart(part.name, std::move(part.shape))});
  }

  std::string setTopology(const vibe_msgs::TissueTopology& message) {
    const std::string problem = graphics::readTopology(message, mesh_);
    has_mesh_ = problem.empty();
    if (has_mesh_) scene_.setMesh(mesh_);
    return problem;
  }

  std::string setParticles(const sensor_msgs::PointCloud2& message) {
    if (!has_mesh_) return "There is no usable tissue/topology yet, so there is no truth of tissue/particles.";
    const std::string problem = graphics::readParticles(message, mesh_, frame_);
    if (problem.empty()) scene_.setFrame(frame_);
    return problem;
  }

  std::string setSutures(const vibe_msgs::SutureArray& message, const PoseOf& poseOf) {
    graphics::SutureDrawing seen;
    const std::string problem = graphics::readSutures(message, seen);
    if (!problem.empty()) return problem;
    const std::optional<Eigen::Isometry3d> pose = poseOf(message.header.frame_id);
    if (!pose) return "There is no transform to the frame '" + message.header.frame_id + "' of the sutures.";
    scene_.setSutures(seen, message.header.stamp.toSec(), *pose);
    return "";
  }

  void placeInstrument(const PoseOf& poseOf) {
    for (const Part& part : parts_) scene_.placePart(part.body, poseOf(part.frame));
  }

  void pressOnLens(const Eigen::Isometry3d& camera) { scene_.pressOnLens(camera); }
  void commit() { scene_.commit(); }

  const TruthScene& scene() const { return scene_; }
  /// The table of labels (labelText()).
  std::string labels() const { return labelText(labelTable(scene_.partNames())); }
  /// What of the robot description cannot be read, one sentence each.
  const std::vector<std::string>& problems() const { return problems_; }

 private:
  struct Part {
    std::string frame;
    std::uint32_t body;
  };
  TruthScene scene_;
  std::vector<Part> parts_;
  std::vector<std::string> problems_;
  graphics::TissueMesh mesh_;
  graphics::TissueFrame frame_;
  bool has_mesh_ = false;
};

}  // namespace vibe::endoscope
