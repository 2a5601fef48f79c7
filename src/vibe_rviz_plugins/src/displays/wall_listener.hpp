#pragma once
#include <ros/node_handle.h>
#include <sensor_msgs/PointCloud2.h>
#include <vibe_msgs/TissueTopology.h>
#include <memory>
#include <string>
#include <vector>

#include "vibe_graphics/geometry/deformable_surface.hpp"
#include "vibe_graphics/geometry/tissue_mesh.hpp"
#include "vibe_graphics/messages/tissue_messages.hpp"

namespace vibe::rviz_plugins {

/// The drawn wall of an organ from tissue/topology and tissue/particles, for displays that put something on it. What is
/// wrong with these messages is said by the display of the tissue. All functions run in the thread that renders.
class WallListener {
 public:
  /// Subscribes or unsubscribes; without effect if nothing changes. What was received is forgotten with the
  /// subscription.
  void listen(ros::NodeHandle& node, bool wanted) {
    if (wanted == listens_) return;
    listens_ = wanted;
    if (wanted) {
      topology_subscriber_ = node.subscribe<vibe_msgs::TissueTopology>(
          "tissue/topology", 2, [this](const vibe_msgs::TissueTopology::ConstPtr& message) { topology_ = message; });
      particles_subscriber_ = node.subscribe<sensor_msgs::PointCloud2>(
          "tissue/particles", 1, [this](const sensor_msgs::PointCloud2::ConstPtr& message) { particles_ = message; });
      return;
    }
    topology_subscriber_.shutdown(), particles_subscriber_.shutdown();
    topology_.reset(), particles_.reset();
    forgot_ = has_mesh_;
    has_mesh_ = placed_ = false;
  }

  /// Takes the newest messages. @return whether there is another mesh than before, or none any more
  bool update() {
    bool another = forgot_;
    forgot_ = false;
    if (topology_) {
      placed_ = false;
      has_mesh_ = graphics::readTopology(*topology_, mesh_).empty();
      if (has_mesh_) surface_ = std::make_unique<graphics::DeformableSurface>(mesh_);
      topology_.reset();
      another = true;
    }
    if (particles_ && has_mesh_ && graphics::readParticles(*particles_, mesh_, frame_).empty()) {
      surface_->update(frame_.positions);
      frame_id_ = particles_->header.frame_id;
      placed_ = true;
    }
    if (has_mesh_) particles_.reset();  // else they wait for their mesh
    return another;
  }

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
