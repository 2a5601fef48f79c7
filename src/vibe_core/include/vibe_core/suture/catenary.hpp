#pragma once
#include <Eigen/Core>

namespace vibe {

/// The shape at rest of a thread that hangs between two points: inextensible, without bending stiffness, of even
/// weight. Along the thread the force is H horizontally everywhere and w (s - s0) vertically, whence
/// T(s) = hypot(H, w (s - s0)) and the height above the first end is s (s - 2 s0) w / (T(s) + T(0)).
/// The shape is that of any even weight; only tensions know how heavy the thread is.
struct Catenary {
  bool taut;      ///< no longer than the distance: straight. Stretch decides its tension, which is 0 here
  double length;  ///< [m]
  double weight;  ///< per length [N/m]
  double scale;   ///< H / w [m]; 0 if the ends are above each other: two strands
  double lowest;  ///< s0: arc length where the thread is or would be level [m], outside 0..length if beyond an end
  Eigen::Vector3d first, last;  ///< its ends [m]
  Eigen::Vector3d up, across;   ///< unit vectors: against gravity; level, towards the last end (0 if none)

  double horizontalTension() const { return weight * scale; }  ///< [N]
  double tension(double arc_length) const;                     ///< [N]; arc length from the first end, 0..length [m]
  double firstTension() const { return tension(0); }           ///< [N]
  double lastTension() const { return tension(length); }       ///< [N]
  Eigen::Vector3d point(double arc_length) const;              ///< [m]
  Eigen::Vector3d lowestPoint() const;                         ///< [m]
};

/// Hangs a thread. As exact as its arguments, nearly straight and nearly vertical too: errors of 1e-13 of the length,
/// and where the spare share e of the length is below 1e-6, of 1e-16 / sqrt(e). Without gravity (a direction of no
/// length, or a weight of 0) nothing pulls and every tension is 0; the shape then sags along gravity_direction, or, if
/// that has no length either, square to the line between the ends.
/// @param first, last         the ends [m], world
/// @param length              of the thread [m], 0 or more
/// @param weight_per_length   [N/m], 0 or more
/// @param gravity_direction   of any length
/// @throws Error  if a number is not finite, or the length or the weight is below 0
Catenary hang(const Eigen::Vector3d& first, const Eigen::Vector3d& last, double length, double weight_per_length,
              const Eigen::Vector3d& gravity_direction);

}  // namespace vibe
