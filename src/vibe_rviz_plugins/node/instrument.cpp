#include "instrument.hpp"

#include <OgreEntity.h>
#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <ros/console.h>
#include <rviz/mesh_loader.h>

#include <algorithm>

#include "geometry/append_shape.hpp"
#include "render/resources.hpp"
#include "robot_visuals.hpp"

namespace vibe::rviz_plugins {
namespace {

void setPose(const Eigen::Isometry3d& pose, Ogre::SceneNode& node) {
  auto real = [](double value) { return static_cast<Ogre::Real>(value); };
  const Eigen::Quaterniond turn(pose.linear());
  node.setPosition(real(pose.translation().x()), real(pose.translation().y()), real(pose.translation().z()));
  node.setOrientation(real(turn.w()), real(turn.x()), real(turn.y()), real(turn.z()));
}

}  // namespace

Instrument::Instrument(Ogre::SceneManager& scene, const std::string& description)
    : scene_(scene), material_(copyMaterial("vibe/solid")) {
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
  dropMaterial(material_);
}

void Instrument::addLink(const std::vector<RobotVisual>& visuals) {
  ColouredShape shape;
  Ogre::SceneNode* node = scene_.getRootSceneNode()->createChildSceneNode();
  for (const RobotVisual& visual : visuals) {
    appendShape(visual.body, shape);
    if (!visual.mesh.empty()) addMesh(visual, *node);
  }
  auto view = std::make_unique<ShapeView>(*node, material_);
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

}  // namespace vibe::rviz_plugins
