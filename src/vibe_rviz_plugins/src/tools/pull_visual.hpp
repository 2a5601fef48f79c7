#pragma once
#include <OgrePrerequisites.h>

#include <Eigen/Core>
#include <memory>

namespace rviz {
class Arrow;
class BillboardLine;
class MovableText;
class Shape;
}  // namespace rviz

namespace vibe::rviz_plugins {

/// The pull spring: a ball at the held patch, a thin line to the target, and an arrow of the force with its magnitude
/// beside it. All positions are in one frame. To be used from the thread that renders.
class PullVisual {
 public:
  explicit PullVisual(Ogre::SceneManager& scene);
  ~PullVisual();
  PullVisual(const PullVisual&) = delete;
  PullVisual& operator=(const PullVisual&) = delete;

  /// Sets the pose of the frame of the positions in the fixed frame.
  void setPose(const Ogre::Vector3& position, const Ogre::Quaternion& orientation);
  /// @param place   position of the held patch [m]
  /// @param target  end of the spring [m]
  void showPull(const Eigen::Vector3d& place, const Eigen::Vector3d& target);
  /// @param force  [N], zero: no arrow
  /// @param scale  length of the arrow per force [m/N]
  void showForce(const Eigen::Vector3d& place, const Eigen::Vector3d& force, double scale);
  void hide();

 private:
  Ogre::SceneManager& scene_;
  Ogre::SceneNode* node_;
  Ogre::SceneNode* text_node_;
  std::unique_ptr<rviz::Shape> ball_;
  std::unique_ptr<rviz::BillboardLine> line_;
  std::unique_ptr<rviz::Arrow> arrow_;
  std::unique_ptr<rviz::MovableText> text_;
};

}  // namespace vibe::rviz_plugins
