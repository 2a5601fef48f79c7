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

namespace vibe {

/// A hand at the tissue: a ball where it holds, a thin line to where it wants the tissue, an arrow of the force with
/// its newtons beside it. All places in one frame. To be used from the thread that renders.
class PullVisual {
 public:
  explicit PullVisual(Ogre::SceneManager& scene);
  ~PullVisual();
  PullVisual(const PullVisual&) = delete;
  PullVisual& operator=(const PullVisual&) = delete;

  /// Where the frame of the places is in the fixed frame.
  void setPose(const Ogre::Vector3& position, const Ogre::Quaternion& orientation);
  /// @param place   where the tissue is held [m]
  /// @param target  where it is wanted [m]
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

}  // namespace vibe
