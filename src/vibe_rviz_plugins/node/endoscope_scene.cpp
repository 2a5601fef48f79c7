#include "endoscope_scene.hpp"

#include <OgreSceneManager.h>
#include <OgreSceneNode.h>

#include "geometry/suture_shapes.hpp"
#include "messages/suture_messages.hpp"
#include "messages/tissue_messages.hpp"

namespace vibe::rviz_plugins {

EndoscopeScene::EndoscopeScene(Ogre::SceneManager& scene, const std::string& description, bool smoke,
                               const MucosaLook& mucosa)
    : suture_node_(*scene.getRootSceneNode()->createChildSceneNode()),
      tissue_(*scene.getRootSceneNode(), mucosa),
      sutures_(suture_node_),
      instrument_(scene, description) {
  TissueLook look;
  look.smoke = smoke;
  tissue_.setLook(look);
}

EndoscopeScene::~EndoscopeScene() = default;

std::string EndoscopeScene::setTopology(const vibe_msgs::TissueTopology& message) {
  const std::string problem = readTopology(message, mesh_);
  has_mesh_ = problem.empty();
  if (has_mesh_)
    tissue_.setMesh(mesh_);
  else
    tissue_.clear();
  blood_.setMesh(has_mesh_ ? &mesh_ : nullptr);
  return problem;
}

std::string EndoscopeScene::read(const sensor_msgs::PointCloud2& message) {
  if (!has_mesh_) return "There is no usable tissue/topology yet, so tissue/particles cannot be drawn.";
  return readParticles(message, mesh_, frame_);
}

std::string EndoscopeScene::setParticles(const sensor_msgs::PointCloud2& message) {
  const std::string problem = read(message);
  if (problem.empty()) tissue_.setFrame(frame_);
  return problem;
}

std::string EndoscopeScene::followParticles(const sensor_msgs::PointCloud2& message) {
  const std::string problem = read(message);
  if (problem.empty()) tissue_.follow(frame_);
  return problem;
}

std::string EndoscopeScene::setSutures(const vibe_msgs::SutureArray& message, const PoseOf& poseOf) {
  SutureDrawing seen;
  const std::string problem = readSutures(message, seen);
  if (!problem.empty()) return problem;
  const std::optional<Eigen::Isometry3d> pose = poseOf(message.header.frame_id);
  if (!pose) return "There is no transform to the frame '" + message.header.frame_id + "' of the sutures.";
  suture_pose_ = *pose;
  const Eigen::Vector3f place = pose->translation().cast<float>();
  const Eigen::Quaternionf turn(pose->linear().cast<float>());
  suture_node_.setPosition(place.x(), place.y(), place.z());
  suture_node_.setOrientation(turn.w(), turn.x(), turn.y(), turn.z());
  shape_.clear();
  appendSutures(seen, naturalSutures(), shape_);
  sutures_.showSolids(shape_);
  BloodStyle style;
  style.time = message.header.stamp.toSec();
  blood_.setWounds(seen, style);
  return "";
}

void EndoscopeScene::drawBlood() {
  if (blood_.update(tissue_.vertices(), suture_pose_.inverse())) sutures_.showBlood(blood_.shape());
}

}  // namespace vibe::rviz_plugins
