#pragma once
#include <message_filters/subscriber.h>
#include <ros/node_handle.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/message_filter.h>
#include <tf2_ros/transform_listener.h>
#include <vibe_msgs/SutureArray.h>
#include <vibe_msgs/TissueTopology.h>

#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "camera_options.hpp"
#include "endoscope_scene.hpp"
#include "image_due.hpp"
#include "sensor/sensor_model.hpp"
#include "truth/truth_camera.hpp"
#include "truth_topics.hpp"
#include "truth_world.hpp"
#include "vibe_graphics/graphics/offscreen_camera.hpp"

namespace vibe::endoscope {

/// Publishes what the endoscope sees as images, one or two per state of the tissue, and the truth beside them: depth,
/// normals, labels, optical flow, pose. An image has the stamp of the tissue it shows, with everything else as it was
/// at that time. Without subscribers it subscribes to nothing, and only what has subscribers is computed. Runs in the
/// thread that calls ros::spin().
class EndoscopeCamera {
 public:
  /// @throws std::runtime_error  the graphics system does not support it
  EndoscopeCamera(ros::NodeHandle node, const CameraOptions& options, Ogre::SceneManager& scene,
                  const std::string& description);

 private:
  /// One of the lenses: the only one, or left or right.
  struct Eye {
    double aside;  ///< distance to the right of the camera frame [m]
    sensor_msgs::CameraInfo numbers;
    ros::Publisher image, info;
    TruthTopics truth;
    bool isWatched() const { return image.getNumSubscribers() + info.getNumSubscribers() > 0 || truth.isWatched(); }
  };
  void addEye(const std::string& name, double aside, const std::string& frame);
  bool isWatched() const;
  void listenAsNeeded();
  void listen();
  void stopListening();

  void receiveTopology(const vibe_msgs::TissueTopology::ConstPtr& message);
  void receiveSutures(const vibe_msgs::SutureArray::ConstPtr& message);
  void followParticles(const sensor_msgs::PointCloud2::ConstPtr& message);
  void receiveParticles(const sensor_msgs::PointCloud2::ConstPtr& message);
  vibe_msgs::SutureArray::ConstPtr suturesAt(const ros::Time& stamp) const;
  std::string draw(const sensor_msgs::PointCloud2& particles, const EndoscopeScene::PoseOf& poseOf);
  std::string drawTruth(const sensor_msgs::PointCloud2& particles, const Eigen::Isometry3d& camera,
                        const EndoscopeScene::PoseOf& poseOf);
  void publish(Eye& eye, const Eigen::Isometry3d& camera, const std_msgs::Header& particles);
  void publishImage(Eye& eye, const Eigen::Isometry3d& camera);
  std::optional<Eigen::Isometry3d> find(const std::string& frame, const std::string& target, const ros::Time& stamp);

  ros::NodeHandle node_;
  CameraOptions options_;
  EndoscopeScene scene_;
  graphics::OffscreenCamera camera_;
  SensorModel sensor_;
  TruthWorld truth_;
  TruthCamera truth_camera_;
  ros::Publisher label_table_;
  std::vector<Eye> eyes_;
  ImageDue due_;

  // while there are subscribers
  tf2_ros::Buffer transforms_;
  std::unique_ptr<tf2_ros::TransformListener> transform_listener_;
  ros::Subscriber topology_, sutures_;
  message_filters::Subscriber<sensor_msgs::PointCloud2> particles_;
  std::unique_ptr<tf2_ros::MessageFilter<sensor_msgs::PointCloud2>> filter_;
  std::deque<vibe_msgs::SutureArray::ConstPtr> recent_sutures_;
  vibe_msgs::SutureArray::ConstPtr drawn_sutures_, true_sutures_;
};

}  // namespace vibe::endoscope
