#include "displays/wall_listener.hpp"

#include "vibe_graphics/messages/tissue_messages.hpp"

namespace vibe::rviz_plugins {

void WallListener::listen(ros::NodeHandle& node, bool wanted) {
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

bool WallListener::update() {
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

}  // namespace vibe::rviz_plugins
