#pragma once
#include <sensor_msgs/PointCloud2.h>
#include <vibe_msgs/SutureArray.h>
#include <vibe_msgs/TissueTopology.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "geometry/bleeding_shape.hpp"
#include "geometry/tissue_mesh.hpp"
#include "instrument.hpp"
#include "render/suture_visual.hpp"
#include "render/tissue_visual.hpp"

namespace vibe::rviz_plugins {

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
  EndoscopeScene(Ogre::SceneManager& scene, const std::string& description, bool smoke, const MucosaLook& mucosa = {});
  ~EndoscopeScene();

  std::string setTopology(const vibe_msgs::TissueTopology& message);
  std::string setParticles(const sensor_msgs::PointCloud2& message);
  /// A state that is not to be drawn: smoke and the colour of marks depend on it (TissueVisual::follow()).
  std::string followParticles(const sensor_msgs::PointCloud2& message);
  std::string setSutures(const vibe_msgs::SutureArray& message, const PoseOf& poseOf);
  /// To be called after changes, before the picture is taken: blood follows the wall.
  void drawBlood();
  void placeInstrument(const PoseOf& poseOf) { instrument_.place(poseOf); }

 private:
  std::string read(const sensor_msgs::PointCloud2& message);

  Ogre::SceneNode& suture_node_;
  TissueVisual tissue_;
  SutureVisual sutures_;
  Instrument instrument_;
  TissueMesh mesh_;
  TissueFrame frame_;
  bool has_mesh_ = false;
  BleedingShape blood_;
  Eigen::Isometry3d suture_pose_ = Eigen::Isometry3d::Identity();
  ColouredShape shape_;  ///< kept, so that a frame allocates little
};

}  // namespace vibe::rviz_plugins
