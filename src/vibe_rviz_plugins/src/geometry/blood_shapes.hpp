#pragma once
#include <Eigen/Core>
#include <vector>

#include "geometry/suture_scene.hpp"
#include "vibe_rviz_plugins/geometry/coloured_shape.hpp"

namespace vibe {

/// How bleeding is drawn. Everything follows from the wounds and the time: the same message gives the same picture.
struct BloodStyle {
  Eigen::Vector3d down{-1, 0, 0};  ///< of gravity, unit; the default is a patient on the back
  double emphasis = 1;             ///< jets and drops are this much thicker
  double time = 0;                 ///< of the message; moves the pulse of brisk bleeding [s]
};

/// Appends what bleeds. Mild: a dark film that grows with what was lost and creeps downwards. Brisk: a bright jet that
/// pulses 72 times a minute, flies as far as gravity lets it, breaks up into drops, and ends in a level pool. Stopped:
/// no jet, and what is left grows brown and pale with its age.
/// The bites tell how far down the wall reaches, which ends the jets.
void appendBlood(const SutureScene& scene, const BloodStyle& style, ColouredShape& shape);

/// A film or pool of this volume [m^3] lying on a plane; what is drawn below the plane only closes the shape.
struct Puddle {
  Eigen::Vector3d centre;  ///< [m]
  Eigen::Vector3d up;      ///< unit, away from the plane
  Eigen::Vector3d creep;   ///< along the plane, where it runs to; length 0 to 1: how much longer it is there
  double volume = 0;       ///< [m^3]
  double thickest = 0;     ///< of its middle [m]; a drop too small for it is a half ball
  double widest = 0;       ///< mean radius it does not exceed [m]; what does not fit is not drawn
  int number = 0;          ///< of the outline
  PackedColour middle = 0, rim = 0;
};
void appendPuddle(const Puddle& puddle, ColouredShape& shape);

/// Mean radius of a puddle's outline [m].
double puddleRadius(const Puddle& puddle);

/// Speed of the blood in a brisk wound's jet as it leaves the wall [m/s].
double jetSpeed(double time);

/// The middle of the jet from the wall to the height `drop` [m] below it: 24 points on the ways of blood that left one
/// after another, each with the speed of its moment.
std::vector<Eigen::Vector3d> jetLine(const Wound& wound, double drop, const BloodStyle& style);

/// Where the jet lands on the average of a beat [m].
Eigen::Vector3d jetLanding(const Wound& wound, double drop, const BloodStyle& style);

}  // namespace vibe
