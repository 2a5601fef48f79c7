#include "endoscope_scene.hpp"

#include <algorithm>

#include <OgreEntity.h>
#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <ros/console.h>
#include <rviz/mesh_loader.h>

#include "robot_shapes.hpp"
#include "vibe_graphics/geometry/coloured_shape.hpp"
#include "vibe_graphics/geometry/suture_shapes.hpp"
#include "vibe_graphics/graphics/resources.hpp"
#include "vibe_graphics/messages/suture_messages.hpp"
#include "vibe_graphics/messages/tissue_messages.hpp"

namespace vibe::endoscope {

namespace {

void setPose(const Eigen::Isometry3d& pose, Ogre::SceneNode& node) {
  auto real = [](double value) { return static_cast<Ogre::Real>(value); };
  const Eigen::Quaterniond turn(pose.linear());
  node.setPosition(real(pose.translation().x()), real(pose.translation().y()), real(pose.translation().z()));
  node.setOrientation(real(turn.w()), real(turn.x()), real(turn.y()), real(turn.z()));
}

}  // namespace

Instrument::Instrument(Ogre::SceneManager& scene, const std::string& description)
    : scene_(scene), material_(graphics::copyMaterial("vibe/solid")) {
  const std::optional<std::vector<RobotVisual>> visuals = robotVisuals(description);
  if (!visuals) {
    ROS_WARN("The parameter 'robot_description' holds no URDF that can be read, so no instrument is in the image.");
    return;
  }
  for (auto begin = visuals->begin(); begin != visuals->end();) {
    const auto end = std::find_if(begin, visuals->end(), [&](const RobotVisual& v) { return v.link != begin->link; });
    addLink({begin, end});
    begin = end;
  }
}

Instrument::~Instrument() {
  for (Part& part : parts_) {
    part.shape.reset();
    while (part.node->numAttachedObjects() > 0) scene_.destroyMovableObject(part.node->getAttachedObject(0));
    part.node->removeAndDestroyAllChildren();
    scene_.destroySceneNode(part.node);
  }
  graphics::dropMaterial(material_);
}

void Instrument::addLink(const std::vector<RobotVisual>& visuals) {
  graphics::ColouredShape shape;
  Ogre::SceneNode* node = scene_.getRootSceneNode()->createChildSceneNode();
  for (const RobotVisual& visual : visuals) {
    graphics::appendShape(visual.body, shape);
    if (!visual.mesh.empty()) addMesh(visual, *node);
  }
  auto view = std::make_unique<graphics::ShapeView>(*node, material_);
  view->show(shape);
  parts_.push_back({visuals.front().link, node, std::move(view)});
}

void Instrument::addMesh(const RobotVisual& visual, Ogre::SceneNode& node) {
  const Ogre::MeshPtr loaded = rviz::loadMeshFromResource(visual.mesh);
  if (!loaded) {
    ROS_WARN_STREAM("The mesh '" << visual.mesh << "' of the robot description cannot be read and is not drawn.");
    return;
  }
  Ogre::SceneNode* place = node.createChildSceneNode();
  setPose(visual.pose, *place);
  const Eigen::Vector3f scale = visual.scale.cast<float>();
  place->setScale(scale.x(), scale.y(), scale.z());
  place->attachObject(scene_.createEntity(loaded));
}

void Instrument::place(const std::function<std::optional<Eigen::Isometry3d>(const std::string&)>& pose_of) {
  for (Part& part : parts_) {
    const std::optional<Eigen::Isometry3d> pose = pose_of(part.frame);
    part.node->setVisible(pose.has_value());
    if (pose) setPose(*pose, *part.node);
  }
}

EndoscopeScene::EndoscopeScene(Ogre::SceneManager& scene, const std::string& description, bool smoke,
                               const graphics::MucosaLook& mucosa)
    : suture_node_(*scene.getRootSceneNode()->createChildSceneNode()),
      tissue_(*scene.getRootSceneNode(), mucosa),
      sutures_(suture_node_),
      instrument_(scene, description) {
  graphics::TissueLook look;
  look.smoke = smoke;
  tissue_.setLook(look);
}

EndoscopeScene::~EndoscopeScene() = default;

std::string EndoscopeScene::setTopology(const vibe_msgs::TissueTopology& message) {
  const std::string problem = graphics::readTopology(message, mesh_);
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
  return graphics::readParticles(message, mesh_, frame_);
}

std::string EndoscopeScene::setParticles(const sensor_msgs::PointCloud2& message) {
  const std::string problem = read(message);
  if (problem.empty()) tissue_.setFrame(frame_);
  return problem;
}

std::string EndoscopeScene::showParticles(const sensor_msgs::PointCloud2& message) {
  const std::string problem = read(message);
  if (problem.empty()) tissue_.show(frame_);
  return problem;
}

std::string EndoscopeScene::followParticles(const sensor_msgs::PointCloud2& message) {
  const std::string problem = read(message);
  if (problem.empty()) tissue_.follow(frame_);
  return problem;
}

std::string EndoscopeScene::setSutures(const vibe_msgs::SutureArray& message, const PoseOf& poseOf) {
  graphics::SutureDrawing seen;
  const std::string problem = graphics::readSutures(message, seen);
  if (!problem.empty()) return problem;
  const std::optional<Eigen::Isometry3d> pose = poseOf(message.header.frame_id);
  if (!pose) return "There is no transform to the frame '" + message.header.frame_id + "' of the sutures.";
  suture_pose_ = *pose;
  const Eigen::Vector3f place = pose->translation().cast<float>();
  const Eigen::Quaternionf turn(pose->linear().cast<float>());
  suture_node_.setPosition(place.x(), place.y(), place.z());
  suture_node_.setOrientation(turn.w(), turn.x(), turn.y(), turn.z());
  shape_.clear();
  graphics::appendSutures(seen, graphics::naturalSutures(), shape_);
  sutures_.showSolids(shape_);
  graphics::BloodStyle style;
  style.time = message.header.stamp.toSec();
  blood_.setWounds(seen, style);
  return "";
}

void EndoscopeScene::drawBlood() {
  if (blood_.update(tissue_.vertices(), suture_pose_.inverse())) sutures_.showBlood(blood_.shape());
}

}  // namespace vibe::endoscope
