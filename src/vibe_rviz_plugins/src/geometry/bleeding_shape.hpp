#pragma once
#include <memory>

#include "geometry/blood_shapes.hpp"
#include "geometry/tissue_mesh.hpp"

namespace vibe::rviz_plugins {

/// The blood of the wounds of a scene on the wall of an organ, made again only if one of them has changed. Without
/// wounds it costs nothing.
class BleedingShape {
 public:
  /// The organ; null: none. It must stay where it is until the next call.
  void setMesh(const TissueMesh* mesh);
  /// Wounds and positions of bites, of one message.
  void setWounds(const SutureDrawing& scene, const BloodStyle& style);

  /// @param wall  vertices of the drawn surface as DeformableSurface has them; null: not known yet
  /// @param pose  of the frame of the wall in that of the wounds
  /// @return  whether the shape has changed
  bool update(const std::vector<MovingVertex>* wall, const Eigen::Isometry3d& pose);

  const ColouredShape& shape() const { return shape_; }  ///< in the frame of the wounds

 private:
  SutureDrawing scene_;
  BloodStyle style_;
  const TissueMesh* mesh_ = nullptr;
  std::unique_ptr<WallSurface> wall_;  // made when the first wound needs it
  ColouredShape shape_;
  bool changed_ = false, on_wall_ = false;
};

}  // namespace vibe::rviz_plugins
