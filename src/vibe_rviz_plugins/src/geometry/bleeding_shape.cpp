#include "geometry/bleeding_shape.hpp"

namespace vibe::rviz_plugins {

void BleedingShape::setMesh(const TissueMesh* mesh) {
  mesh_ = mesh;
  wall_.reset();
  changed_ = changed_ || !scene_.wounds.empty();
}

void BleedingShape::setWounds(const SutureDrawing& scene, const BloodStyle& style) {
  changed_ = changed_ || !scene.wounds.empty() || !scene_.wounds.empty();
  scene_ = scene;
  style_ = style;
}

bool BleedingShape::update(const std::vector<MovingVertex>* wall, const Eigen::Isometry3d& pose) {
  if (scene_.wounds.empty() && !changed_) return false;
  const bool on_wall = wall != nullptr && mesh_ != nullptr && !scene_.wounds.empty();
  if (on_wall && !wall_) wall_ = std::make_unique<WallSurface>(mesh_->triangles, mesh_->vertex_count);
  const bool moved = on_wall && wall_->move(*wall, pose);
  if (!changed_ && !moved && on_wall == on_wall_) return false;
  shape_.clear();
  appendBlood(scene_, style_, on_wall ? wall_.get() : nullptr, shape_);
  changed_ = false, on_wall_ = on_wall;
  return true;
}

}  // namespace vibe::rviz_plugins
