#pragma once
#include <Eigen/Core>
#include <vector>

#include "geometry/blood_jet.hpp"
#include "geometry/blood_style.hpp"
#include "geometry/suture_drawing.hpp"
#include "geometry/wall_surface.hpp"
#include "vibe_rviz_plugins/geometry/coloured_shape.hpp"

namespace vibe::rviz_plugins {

/// Appends all bleeding. On a wall: films, rivulets and pools as flowOf() finds them, and the pulsing jets of brisk
/// wounds; a jet pulses 72 times a minute, follows a ballistic path, and breaks up into drops. Stopped: no jet, and the
/// rest turns brown and pale with age.
/// Without a wall: a dark film that grows with the amount lost and creeps downwards, and a jet that ends in a level
/// pool at the height of the lowest bite.
/// @param wall  null: not known. A wound with no wall near is drawn as without.
void appendBlood(const SutureDrawing& scene, const BloodStyle& style, const WallSurface* wall, ColouredShape& shape);

/// A film or pool of this volume [m^3] lying on a plane; what is drawn below the plane only closes the shape.
struct Puddle {
  Eigen::Vector3d centre;  ///< [m]
  Eigen::Vector3d up;      ///< unit, away from the plane
  Eigen::Vector3d creep;   ///< direction of creep along the plane; its length, 0 to 1, is the elongation
  double volume = 0;       ///< [m^3]
  double max_height = 0;   ///< maximum height [m]; a drop too small to reach it is a hemisphere
  double max_radius = 0;   ///< maximum mean radius [m]; the volume beyond is not drawn
  int number = 0;          ///< of the outline
  PackedColour middle = 0, rim = 0;
};
void appendPuddle(const Puddle& puddle, ColouredShape& shape);

/// Mean radius of a puddle's outline [m].
double puddleRadius(const Puddle& puddle);

}  // namespace vibe::rviz_plugins
