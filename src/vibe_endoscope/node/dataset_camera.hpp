#pragma once
#include <optional>
#include <string>
#include <vector>

#include "dataset_folder.hpp"
#include "endoscope_scene.hpp"
#include "sensor/sensor_model.hpp"
#include "truth_world.hpp"
#include "vibe_graphics/graphics/offscreen_camera.hpp"

namespace vibe::endoscope {

/// Takes the images of a data set: what is drawn, and the truth, at chosen states of a session.
class DatasetCamera {
 public:
  /// @throws std::runtime_error  the graphics system or Embree cannot be used
  DatasetCamera(const DatasetOptions& options, Ogre::SceneManager& scene, const std::string& description);

  /// To be told of each state in order, taken or not, so that smoke and the age of marks do not depend on the choice.
  /// @return one sentence if the state is wrong
  std::string follow(const SessionFrame& frame);
  /// Takes the state that follow() was told last.
  /// @return one sentence if the state is wrong; then nothing is written
  std::string take(const SessionFrame& frame, const JointTree& poses, DatasetFolder& folder);

  std::size_t images() const { return images_; }
  std::string labels() const { return truth_.labels(); }

 private:
  struct Eye {
    std::string folder;
    double aside;                     // to the right of the camera frame [m]
    std::optional<TruthView> before;  // from which the flow starts
  };
  std::string show(const SessionFrame& frame, const Eigen::Isometry3d& camera, const EndoscopeScene::PoseOf& poseOf);
  void takeEye(Eye& eye, const Eigen::Isometry3d& camera, const ros::Time& stamp, DatasetFolder& folder);

  DatasetOptions options_;
  EndoscopeScene drawn_;
  TruthWorld truth_;
  graphics::OffscreenCamera camera_;
  TruthCamera truth_camera_;
  SensorModel sensor_;
  std::vector<Eye> eyes_;
  vibe_msgs::TissueTopology::ConstPtr topology_, written_topology_;
  vibe_msgs::SutureArray::ConstPtr sutures_;
  std::size_t images_ = 0;
};

}  // namespace vibe::endoscope
