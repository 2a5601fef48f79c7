#include "tools/pull_visual.hpp"

#include <OgreQuaternion.h>
#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <OgreVector3.h>
#include <rviz/ogre_helpers/arrow.h>
#include <rviz/ogre_helpers/billboard_line.h>
#include <rviz/ogre_helpers/movable_text.h>
#include <rviz/ogre_helpers/shape.h>

#include <algorithm>
#include <cstdio>

namespace vibe::rviz_plugins {

namespace {

constexpr float kBall = 5e-3F;        // diameter [m]
constexpr float kShaft = 1.8e-3F;     // diameter [m]
constexpr float kHead = 4.5e-3F;      // diameter [m]
constexpr float kHeadLength = 7e-3F;  // at most, and half of the arrow [m]
constexpr float kLineWidth = 6e-4F;   // width [m]
constexpr float kLetter = 1e-2F;      // height [m]
constexpr double kTextGap = 9e-3;     // from the arrow's tip [m]
constexpr double kMinArrow = 5e-4;    // shorter ones are not drawn [m]

Ogre::Vector3 toOgre(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

}  // namespace

PullVisual::PullVisual(Ogre::SceneManager& scene)
    : scene_(scene),
      node_(scene.getRootSceneNode()->createChildSceneNode()),
      text_node_(node_->createChildSceneNode()),
      ball_(std::make_unique<rviz::Shape>(rviz::Shape::Sphere, &scene, node_)),
      line_(std::make_unique<rviz::BillboardLine>(&scene, node_)),
      arrow_(std::make_unique<rviz::Arrow>(&scene, node_)),
      text_(std::make_unique<rviz::MovableText>("0.00 N", "Liberation Sans", kLetter, Ogre::ColourValue::White)) {
  ball_->setScale(Ogre::Vector3(kBall));
  ball_->setColor(1, 0.85F, 0.2F, 1);
  line_->setLineWidth(kLineWidth);
  arrow_->setColor(0.1F, 0.9F, 0.35F, 1);
  text_->setTextAlignment(rviz::MovableText::H_CENTER, rviz::MovableText::V_CENTER);
  text_->showOnTop();
  text_node_->attachObject(text_.get());
  hide();
}

PullVisual::~PullVisual() {
  text_node_->detachAllObjects();
  text_.reset();
  arrow_.reset();
  line_.reset();
  ball_.reset();
  scene_.destroySceneNode(text_node_);
  scene_.destroySceneNode(node_);
}

void PullVisual::setPose(const Ogre::Vector3& position, const Ogre::Quaternion& orientation) {
  node_->setPosition(position);
  node_->setOrientation(orientation);
}

void PullVisual::showPull(const Eigen::Vector3d& place, const Eigen::Vector3d& target) {
  node_->setVisible(true);
  arrow_->getSceneNode()->setVisible(false);
  text_node_->setVisible(false);
  ball_->setPosition(toOgre(place));
  line_->clear();
  line_->setColor(1, 1, 1, 0.8F);
  line_->addPoint(toOgre(place));
  line_->addPoint(toOgre(target));
}

void PullVisual::showForce(const Eigen::Vector3d& place, const Eigen::Vector3d& force, double scale) {
  const double length = force.norm() * scale;
  const bool shown = length > kMinArrow;
  arrow_->getSceneNode()->setVisible(shown);
  text_node_->setVisible(shown);
  if (!shown) return;
  const float head = std::min(kHeadLength, static_cast<float>(length) / 2);
  arrow_->set(static_cast<float>(length) - head, kShaft, head, kHead);
  arrow_->setPosition(toOgre(place));
  arrow_->setDirection(toOgre(force.normalized()));
  char newtons[32];
  std::snprintf(newtons, sizeof newtons, "%.2f N", force.norm());
  text_->setCaption(newtons);
  text_node_->setPosition(toOgre(place + (length + kTextGap) * force.normalized()));
}

void PullVisual::hide() {
  node_->setVisible(false);
}

}  // namespace vibe::rviz_plugins
