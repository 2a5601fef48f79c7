#pragma once
#include <ros/node_handle.h>
#include <sensor_msgs/PointCloud2.h>
#include <vibe_msgs/TissueTopology.h>

#include <memory>
#include <string>
#include <vector>

#include "vibe_graphics/geometry/deformable_surface.hpp"
#include "vibe_graphics/geometry/tissue_mesh.hpp"

namespace vibe::rviz_plugins {

/// The drawn wall of an organ from tissue/topology and tissue/particles, for displays that put something on it. What is
/// wrong with these messages is said by the display of the tissue. All functions run in the thread that renders.
class WallListener {
 public:
  /// Subscribes or unsubscribes; without effect if nothing changes. What was received is forgotten with the
  /// subscription.
  void listen(ros::NodeHandle& node, bool wanted);

  /// Takes the newest messages. @return whether there is another mesh than before, or none any more
  bool update();

  const graphics::TissueMesh* mesh() const { return has_mesh_ ? &mesh_ : nullptr; }
  /// As DeformableSurface has them; null: none yet.
  const std::vector<graphics::MovingVertex>* vertices() const { return placed_ ? &surface_->vertices() : nullptr; }
  const std::string& frame() const { return frame_id_; }  ///< of the vertices

 private:
  ros::Subscriber topology_subscriber_, particles_subscriber_;
  vibe_msgs::TissueTopology::ConstPtr topology_;  // not read yet
  sensor_msgs::PointCloud2::ConstPtr particles_;  // not read yet
  graphics::TissueMesh mesh_;
  graphics::TissueFrame frame_;
  std::unique_ptr<graphics::DeformableSurface> surface_;
  std::string frame_id_;
  bool listens_ = false, has_mesh_ = false, placed_ = false, forgot_ = false;
};

}  // namespace vibe::rviz_plugins
