#pragma once
#include <Eigen/Core>

namespace vibe {

/// The rest shape of a thread that hangs between two points. The thread is inextensible, has no bending stiffness and
/// has uniform weight. The horizontal force is H everywhere and the vertical force is w (s - s0), so the tension is
/// T(s) = hypot(H, w (s - s0)) and the height above the first end is s (s - 2 s0) w / (T(s) + T(0)). The shape does not
/// depend on the weight; only the tensions do.
struct Catenary {
  bool taut;      ///< no longer than the distance of the ends; tension is 0 here, stretch determines it
  double length;  ///< of the thread [m]
  double weight;  ///< per length [N/m]
  double scale;   ///< H / w [m]; 0 if one end is above the other: two vertical strands
  double lowest;  ///< s0: arc length of the (extended) thread's level point [m]; outside 0..length if beyond an end
  Eigen::Vector3d first, last;  ///< the ends [m]
  Eigen::Vector3d up, across;   ///< unit vectors: against gravity; horizontal towards the last end (0 if none)

  double horizontalTension() const { return weight * scale; }  ///< [N]
  double tension(double arc_length) const;                     ///< [N]; arc length from the first end, 0..length [m]
  double firstTension() const { return tension(0); }           ///< [N]
  double lastTension() const { return tension(length); }       ///< [N]
  Eigen::Vector3d point(double arc_length) const;              ///< [m]
  Eigen::Vector3d lowestPoint() const;                         ///< [m]
};

/// Computes the shape of a hanging thread. The result is as accurate as the arguments, also for nearly straight and
/// nearly vertical threads: errors are 1e-13 of the length. Where the excess share e of the length is below 1e-6, they
/// are 1e-16 / sqrt(e). Without gravity (a zero direction or a weight of 0) every tension is 0. The thread then sags
/// along gravity_direction or, if that is zero, perpendicular to the line between the ends.
/// @param first, last         the ends [m], world
/// @param length              of the thread [m], 0 or more
/// @param weight_per_length   [N/m], 0 or more
/// @param gravity_direction   of any length
/// @throws Error  if a number is not finite, or the length or the weight is below 0
Catenary hang(const Eigen::Vector3d& first, const Eigen::Vector3d& last, double length, double weight_per_length,
              const Eigen::Vector3d& gravity_direction);

}  // namespace vibe
