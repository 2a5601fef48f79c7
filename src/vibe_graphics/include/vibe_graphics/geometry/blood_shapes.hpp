#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "vibe_graphics/geometry/blood_colour.hpp"
#include "vibe_graphics/geometry/blood_flow.hpp"
#include "vibe_graphics/geometry/coloured_shape.hpp"
#include "vibe_graphics/geometry/suture_drawing.hpp"
#include "vibe_graphics/geometry/tissue_mesh.hpp"
#include "vibe_graphics/geometry/wall_surface.hpp"

namespace vibe::graphics {

/// Appends all bleeding. On a wall: films, rivulets and pools as flowOf() finds them, and the pulsing jets of brisk
/// wounds; a jet pulses 72 times a minute, follows a ballistic path, and breaks up into drops. Stopped: no jet, and the
/// rest turns brown and pale with age.
/// Without a wall: a dark film that grows with the amount lost and creeps downwards, and a jet that ends in a level
/// pool at the height of the lowest bite.
/// @param wall  null: not known. A wound with no wall near is drawn as without.
void appendBlood(const SutureDrawing& scene, const BloodStyle& style, const WallSurface* wall, ColouredShape& shape);

/// A film or pool of this volume [m^3] lying on a plane; what is drawn below the plane only closes the shape.
struct Puddle {
  Eigen::Vector3d centre;            ///< [m]
  Eigen::Vector3d up;                ///< unit, away from the plane
  Eigen::Vector3d creep;             ///< direction of creep along the plane; its length, 0 to 1, is the elongation
  double volume = 0;                 ///< [m^3]
  double max_height = 0;             ///< maximum height [m]; a drop too small to reach it is a hemisphere
  double max_radius = 0;             ///< maximum mean radius [m]; the volume beyond is not drawn
  int number = 0;                    ///< of the outline
  PackedColour middle = 0, rim = 0;  ///< colours of the top, and of the outline on the plane
};
/// Appends a puddle; nothing if its volume or a maximum is 0.
void appendPuddle(const Puddle& puddle, ColouredShape& shape);

/// Mean radius of a puddle's outline [m].
double puddleRadius(const Puddle& puddle);

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

}  // namespace vibe::graphics
