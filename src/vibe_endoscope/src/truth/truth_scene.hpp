#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "truth/label_table.hpp"
#include "truth/ray_scene.hpp"
#include "vibe_graphics/geometry/blood_shapes.hpp"
#include "vibe_graphics/geometry/coloured_shape.hpp"
#include "vibe_graphics/geometry/deformable_surface.hpp"
#include "vibe_graphics/geometry/suture_drawing.hpp"
#include "vibe_graphics/geometry/tissue_mesh.hpp"

namespace vibe::endoscope {

/// Everything that an endoscope sees, as triangles with labels: the same that are drawn. The frame of the scene is that
/// of the particles; lengths in metres.
class TruthScene {
 public:
  /// @throws std::runtime_error  Embree cannot be used
  TruthScene();

  void setMesh(const graphics::TissueMesh& mesh);
  /// The organ at another moment; a frame of another revision than the mesh is an error of the caller.
  void setFrame(const graphics::TissueFrame& frame);
  /// Brings the wall of the last frame to where a camera at this pose shows it (graphics::placeOnLens()).
  void pressOnLens(const Eigen::Isometry3d& camera);
  /// @param time  of the message: bleeding pulses [s]
  /// @param pose  of the frame of the sutures in that of the scene
  void setSutures(const graphics::SutureDrawing& sutures, double time, const Eigen::Isometry3d& pose);
  /// Adds a rigid part of the instrument; parts with the same name have the same label.
  /// @throws std::runtime_error  there are more names than labels
  std::uint32_t addPart(const std::string& name, graphics::ColouredShape shape);
  /// @param part  as addPart() returned it; without a pose the part is not seen
  void placePart(std::uint32_t part, const std::optional<Eigen::Isometry3d>& pose);
  /// To be called after changes, before the scene is looked at.
  void commit();

  const RayScene& rays() const { return rays_; }
  const std::vector<std::string>& partNames() const { return part_names_; }

  // Of hits, in the frame of their body. The shapes of rigid parts stand still there; all others are in the frame of
  // the scene.

  /// Where the point of a hit is now [m].
  Eigen::Vector3d pointOf(const SurfaceHit& hit) const;
  /// Unit normal as it is shaded: interpolated between the corners, on the side of `towards`. The plane of the triangle
  /// takes its place where it would point away.
  /// @param towards  from the point to the camera, of any length
  Eigen::Vector3d normalOf(const SurfaceHit& hit, const Eigen::Vector3d& towards) const;
  /// @param towards  as above
  std::uint8_t labelOf(const SurfaceHit& hit, const Eigen::Vector3d& towards) const;

  /// Pose of the frame of a body in the frame of the scene.
  const Eigen::Isometry3d& poseOf(std::uint32_t body) const { return bodies_[body].pose; }
  /// Changes whenever the triangles of a body do: a hit belongs to the same material point only while it is the same.
  /// 0: points of this body are not material (blood), or it is not there.
  std::uint64_t shapeNumber(std::uint32_t body) const { return bodies_[body].placed ? bodies_[body].shape_number : 0; }
  std::uint32_t bodyCount() const { return static_cast<std::uint32_t>(bodies_.size()); }

 private:
  struct Body {
    std::uint8_t label = kLabelNothing;
    graphics::ColouredShape own;  // of all bodies but the wall
    const std::vector<graphics::MovingVertex>* vertices = nullptr;
    const std::vector<std::uint32_t>* triangles = nullptr;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    std::uint64_t shape_number = 0;
    bool placed = true;
  };

  std::uint32_t addBody(std::uint8_t label, std::uint32_t number);
  void setShape(std::uint32_t body, graphics::ColouredShape shape, const Eigen::Isometry3d& pose, bool material);

  RayScene rays_;
  graphics::TissueMesh mesh_;
  std::unique_ptr<graphics::DeformableSurface> surface_;
  std::vector<graphics::MovingVertex> pressed_;  // the wall's vertices, while some lie on the lens
  WallLabels wall_labels_;
  graphics::BleedingShape bleeding_;
  Eigen::Isometry3d suture_pose_ = Eigen::Isometry3d::Identity();
  std::deque<Body> bodies_;  // a deque, because rays_ refers to the shapes
  std::uint32_t wall_, thread_, tag_, cinch_, blood_;
  std::vector<std::string> part_names_;
  std::uint64_t shapes_ = 0;
};

}  // namespace vibe::endoscope
