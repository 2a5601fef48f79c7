#pragma once
#include <Eigen/Core>
#include <vector>

#include "geometry/suture_scene.hpp"
#include "vibe_rviz_plugins/geometry/coloured_shape.hpp"

namespace vibe {

/// How bleeding is drawn. The shape depends on the message alone, including its time.
struct BloodStyle {
  Eigen::Vector3d down{-1, 0, 0};  ///< direction of gravity, unit; default: patient in supine position
  double emphasis = 1;             ///< factor for the thickness of jets and drops
  double time = 0;                 ///< of the message; phase of the pulse of brisk bleeding [s]
};

/// Appends all bleeding. Mild: a dark film that grows with the amount lost and creeps downwards. Brisk: a bright jet
/// that pulses 72 times a minute, follows a ballistic path, breaks up into drops, and ends in a level pool. Stopped: no
/// jet, and the rest turns brown and pale with age. The lowest bite determines where the jets end.
void appendBlood(const SutureScene& scene, const BloodStyle& style, ColouredShape& shape);

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

/// Initial speed of the jet of a brisk wound [m/s].
double jetSpeed(double time);

/// Centre line of the jet from the wall to the height `drop` [m] below it: 24 points on the paths of blood that left
/// one after another, each with the speed at that time.
std::vector<Eigen::Vector3d> jetLine(const Wound& wound, double drop, const BloodStyle& style);

/// Where the jet lands on the average of a beat [m].
Eigen::Vector3d jetLanding(const Wound& wound, double drop, const BloodStyle& style);

}  // namespace vibe
