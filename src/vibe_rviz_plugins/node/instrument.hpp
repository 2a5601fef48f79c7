#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/shape_view.hpp"

namespace Ogre {
class Entity;
class SceneManager;
class SceneNode;
}  // namespace Ogre

namespace vibe::rviz_plugins {

struct RobotVisual;

/// The visible parts of a robot description: the endoscope with its suturing device.
class Instrument {
 public:
  /// @param description  URDF; with none, or one that cannot be read, nothing is drawn and a warning says so
  Instrument(Ogre::SceneManager& scene, const std::string& description);
  ~Instrument();
  Instrument(const Instrument&) = delete;
  Instrument& operator=(const Instrument&) = delete;

  /// Moves every link to `poseOf(frame)` in the scene; links without a pose are not drawn.
  void place(const std::function<std::optional<Eigen::Isometry3d>(const std::string&)>& poseOf);

 private:
  struct Part {
    std::string frame;
    Ogre::SceneNode* node;
    std::unique_ptr<ShapeView> shape;
  };
  /// @param visuals  of one link, at least one
  void addLink(const std::vector<RobotVisual>& visuals);
  void addMesh(const RobotVisual& visual, Ogre::SceneNode& node);

  Ogre::SceneManager& scene_;
  Ogre::MaterialPtr material_;
  std::vector<Part> parts_;
};

}  // namespace vibe::rviz_plugins
