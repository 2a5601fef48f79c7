#include "instrument.hpp"

#include <OgreEntity.h>
#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <ros/console.h>
#include <rviz/mesh_loader.h>
#include <urdf/model.h>

#include "render/resources.hpp"
#include "vibe_rviz_plugins/geometry/solid_bodies.hpp"

namespace vibe {
namespace {

Eigen::Isometry3d poseOf(const urdf::Pose& origin) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Eigen::Vector3d(origin.position.x, origin.position.y, origin.position.z));
  double x, y, z, w;
  origin.rotation.getQuaternion(x, y, z, w);
  pose.rotate(Eigen::Quaterniond(w, x, y, z).normalized());
  return pose;
}

PackedColour colourOf(const urdf::Visual& visual) {
  if (!visual.material) return packed(0.6, 0.6, 0.62);
  const urdf::Color& colour = visual.material->color;
  return packed(colour.r, colour.g, colour.b);
}

/// @return whether the visual is a simple body
bool appendVisual(const urdf::Visual& visual, ColouredShape& shape) {
  const Eigen::Isometry3d pose = poseOf(visual.origin);
  if (const auto* ball = dynamic_cast<const urdf::Sphere*>(visual.geometry.get()))
    return appendSphere(pose, ball->radius, colourOf(visual), shape), true;
  if (const auto* rod = dynamic_cast<const urdf::Cylinder*>(visual.geometry.get()))
    return appendCylinder(pose, rod->radius, rod->length, colourOf(visual), shape), true;
  if (const auto* box = dynamic_cast<const urdf::Box*>(visual.geometry.get()))
    return appendBox(pose, {box->dim.x, box->dim.y, box->dim.z}, colourOf(visual), shape), true;
  return false;
}

void setPose(const Eigen::Isometry3d& pose, Ogre::SceneNode& node) {
  auto real = [](double value) { return static_cast<Ogre::Real>(value); };
  const Eigen::Quaterniond turn(pose.linear());
  node.setPosition(real(pose.translation().x()), real(pose.translation().y()), real(pose.translation().z()));
  node.setOrientation(real(turn.w()), real(turn.x()), real(turn.y()), real(turn.z()));
}

}  // namespace

Instrument::Instrument(Ogre::SceneManager& scene, const std::string& description)
    : scene_(scene), material_(copyMaterial("vibe/solid")) {
  urdf::Model model;
  if (description.empty() || !model.initString(description)) {
    ROS_WARN("The parameter 'robot_description' holds no URDF that can be read, so no instrument is in the image.");
    return;
  }
  for (const auto& [name, link] : model.links_)
    if (!link->visual_array.empty()) addLink(*link);
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

void Instrument::addLink(const urdf::Link& link) {
  ColouredShape shape;
  Ogre::SceneNode* node = scene_.getRootSceneNode()->createChildSceneNode();
  for (const auto& visual : link.visual_array)
    if (visual && visual->geometry && !appendVisual(*visual, shape)) addMesh(*visual, *node);
  auto view = std::make_unique<ShapeView>(*node, material_);
  view->show(shape);
  parts_.push_back({link.name, node, std::move(view)});
}

void Instrument::addMesh(const urdf::Visual& visual, Ogre::SceneNode& node) {
  const auto* mesh = dynamic_cast<const urdf::Mesh*>(visual.geometry.get());
  if (mesh == nullptr) return;
  const Ogre::MeshPtr loaded = rviz::loadMeshFromResource(mesh->filename);
  if (!loaded) {
    ROS_WARN_STREAM("The mesh '" << mesh->filename << "' of the robot description cannot be read and is not drawn.");
    return;
  }
  Ogre::SceneNode* place = node.createChildSceneNode();
  setPose(poseOf(visual.origin), *place);
  place->setScale(static_cast<Ogre::Real>(mesh->scale.x), static_cast<Ogre::Real>(mesh->scale.y),
                  static_cast<Ogre::Real>(mesh->scale.z));
  place->attachObject(scene_.createEntity(loaded));
}

void Instrument::place(const std::function<std::optional<Eigen::Isometry3d>(const std::string&)>& pose_of) {
  for (Part& part : parts_) {
    const std::optional<Eigen::Isometry3d> pose = pose_of(part.frame);
    part.node->setVisible(pose.has_value());
    if (pose) setPose(*pose, *part.node);
  }
}

}  // namespace vibe
