#include "truth_world.hpp"

#include "robot_shapes.hpp"
#include "vibe_graphics/messages/suture_messages.hpp"
#include "vibe_graphics/messages/tissue_messages.hpp"

namespace vibe::endoscope {

TruthWorld::TruthWorld(const std::string& description) {
  for (RobotShape& part : robotShapes(description, problems_))
    parts_.push_back({part.frame, scene_.addPart(part.name, std::move(part.shape))});
}

std::string TruthWorld::setTopology(const vibe_msgs::TissueTopology& message) {
  const std::string problem = graphics::readTopology(message, mesh_);
  has_mesh_ = problem.empty();
  if (has_mesh_) scene_.setMesh(mesh_);
  return problem;
}

std::string TruthWorld::setParticles(const sensor_msgs::PointCloud2& message) {
  if (!has_mesh_) return "There is no usable tissue/topology yet, so there is no truth of tissue/particles.";
  const std::string problem = graphics::readParticles(message, mesh_, frame_);
  if (problem.empty()) scene_.setFrame(frame_);
  return problem;
}

std::string TruthWorld::setSutures(const vibe_msgs::SutureArray& message, const PoseOf& poseOf) {
  graphics::SutureDrawing seen;
  const std::string problem = graphics::readSutures(message, seen);
  if (!problem.empty()) return problem;
  const std::optional<Eigen::Isometry3d> pose = poseOf(message.header.frame_id);
  if (!pose) return "There is no transform to the frame '" + message.header.frame_id + "' of the sutures.";
  scene_.setSutures(seen, message.header.stamp.toSec(), *pose);
  return "";
}

void TruthWorld::placeInstrument(const PoseOf& poseOf) {
  for (const Part& part : parts_) scene_.placePart(part.body, poseOf(part.frame));
}

}  // namespace vibe::endoscope
