#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <sensor_msgs/PointCloud2.h>
#include <vibe_msgs/SutureArray.h>
#include <vibe_msgs/TissueTopology.h>
#include <Eigen/Geometry>

#include "vibe_graphics/geometry/blood_shapes.hpp"
#include "vibe_graphics/geometry/tissue_mesh.hpp"
#include "vibe_graphics/graphics/shape_visual.hpp"
#include "vibe_graphics/graphics/suture_visual.hpp"
#include "vibe_graphics/graphics/tissue_visual.hpp"

namespace Ogre {

class Entity;
class SceneManager;
class SceneNode;

}  // namespace Ogre

namespace vibe::endoscope {

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
    std::unique_ptr<graphics::ShapeView> shape;
  };
  /// @param visuals  of one link, at least one
  void addLink(const std::vector<RobotVisual>& visuals);
  void addMesh(const RobotVisual& visual, Ogre::SceneNode& node);

  Ogre::SceneManager& scene_;
  Ogre::MaterialPtr material_;
  std::vector<Part> parts_;
};

/// Everything that an endoscope sees, in a scene of Ogre: tissue, sutures, blood, instrument. Its frame is that of the
/// particles. Functions that take a message return one sentence if it is wrong, and the scene stays as it is; otherwise
/// they return an empty string.
class EndoscopeScene {
 public:
  /// Pose of a frame in the frame of the scene at the time that is drawn.
  using PoseOf = std::function<std::optional<Eigen::Isometry3d>(const std::string& frame)>;

  /// @param description  URDF of the instrument
  /// @param smoke        whether the argon beam makes smoke
  /// @param mucosa       what it looks like
  /// @throws std::runtime_error  the package's media folder cannot be found
  EndoscopeScene(Ogre::SceneManager& scene, const std::string& description, bool smoke,
                 const graphics::MucosaLook& mucosa = {});
  ~EndoscopeScene();

  std::string setTopology(const vibe_msgs::TissueTopology& message);
  std::string setParticles(const sensor_msgs::PointCloud2& message);
  /// The same for a state that has been followed.
  std::string showParticles(const sensor_msgs::PointCloud2& message);
  /// A state that is not to be drawn: smoke and the colour of marks depend on it (TissueVisual::follow()).
  std::string followParticles(const sensor_msgs::PointCloud2& message);
  std::string setSutures(const vibe_msgs::SutureArray& message, const PoseOf& poseOf);
  /// To be called after changes, before the picture is taken: blood follows the wall.
  void drawBlood();
  void placeInstrument(const PoseOf& poseOf) { instrument_.place(poseOf); }

 private:
  std::string read(const sensor_msgs::PointCloud2& message);

  Ogre::SceneNode& suture_node_;
  graphics::TissueVisual tissue_;
  graphics::SutureVisual sutures_;
  Instrument instrument_;
  graphics::TissueMesh mesh_;
  graphics::TissueFrame frame_;
  bool has_mesh_ = false;
  graphics::BleedingShape blood_;
  Eigen::Isometry3d suture_pose_ = Eigen::Isometry3d::Identity();
  graphics::ColouredShape shape_;  ///< kept, so that a frame allocates little
};

}  // namespace vibe::endoscope
