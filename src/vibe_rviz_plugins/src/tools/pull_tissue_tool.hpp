#pragma once
#ifndef Q_MOC_RUN
#include <ros/ros.h>
#include <rviz/tool.h>
#include <sensor_msgs/PointCloud2.h>
#include <vibe_msgs/TissuePullState.h>
#include <vibe_msgs/TissueTopology.h>

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>

#include "vibe_graphics/geometry/tissue_mesh.hpp"
#include "vibe_operator/drive/mouse_ray.hpp"
#include "vibe_operator/messages/command_messages.hpp"
#endif

namespace rviz {
class FloatProperty;
class StringProperty;
}  // namespace rviz

namespace vibe::rviz_plugins {

class PullVisual;

/// Pulls the tissue under the mouse with commands on tissue/pull. Subscribes to the tissue only while it is the active
/// tool.
class PullTissueTool : public rviz::Tool {
  Q_OBJECT

 public:
  PullTissueTool();
  ~PullTissueTool() override;

  void onInitialize() override;
  void activate() override;
  void deactivate() override;
  void update(float wall_dt, float ros_dt) override;
  int processMouseEvent(rviz::ViewportMouseEvent& event) override;

 private Q_SLOTS:
  void connectAgain();

 private:
  /// What the mouse holds. Positions are in the frame of the topology.
  struct Hold {
    int particle = -1;
    Eigen::Vector3d place = Eigen::Vector3d::Zero();   ///< of the tissue when it was grabbed [m]
    Eigen::Vector3d drag = Eigen::Vector3d::Zero();    ///< motion of the mouse since then [m]
    Eigen::Vector3d cursor = Eigen::Vector3d::Zero();  ///< point under the mouse at the depth of the target [m]
    bool answered = false;                             ///< the simulator has answered
    ros::WallTime since;                               ///< time of the last answer, or of the start
    Eigen::Vector3d target() const { return place + drag; }
  };

  void connect();
  void disconnect();
  void takeTopology(const vibe_msgs::TissueTopology::ConstPtr& message);
  void takeParticles(const sensor_msgs::PointCloud2::ConstPtr& message) { latest_ = message; }
  void takeState(const vibe_msgs::TissuePullState::ConstPtr& message);
  std::string findTissue();
  bool framePose(Eigen::Isometry3d& pose);
  /// Ray through the mouse, or this number of pixels below it.
  operating::MouseRay rayOf(const rviz::ViewportMouseEvent& event, const Eigen::Isometry3d& frame, int below = 0) const;
  Eigen::Vector3d viewDirection(const rviz::ViewportMouseEvent& event, const Eigen::Isometry3d& frame) const;
  void take(const rviz::ViewportMouseEvent& event);
  void drag(rviz::ViewportMouseEvent& event);
  void letGo();
  void send(int particle, const Eigen::Vector3d& target);
  void showStatus(const std::string& text);
  void showHowTo();
  void draw(const Eigen::Vector3d& place, const Eigen::Vector3d& force);

  rviz::StringProperty* namespace_;
  rviz::FloatProperty* scale_;

  ros::NodeHandle handle_;
  ros::Publisher publisher_;
  ros::Subscriber topology_subscriber_, particles_subscriber_, state_subscriber_;
  sensor_msgs::PointCloud2::ConstPtr latest_;
  graphics::TissueMesh mesh_;
  graphics::TissueFrame tissue_;
  std::string topology_trouble_;  // why there is no mesh; empty if there is one
  std::optional<Hold> hold_;
  std::unique_ptr<PullVisual> visual_;
  bool active_ = false;
};

}  // namespace vibe::rviz_plugins
