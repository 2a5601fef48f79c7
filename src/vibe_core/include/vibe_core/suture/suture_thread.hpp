#pragma once

#include <Eigen/Core>

namespace vibe {

/// Material of a suture thread. SI units.
struct ThreadMaterial {
  double diameter;                               ///< [m]
  double density;                                ///< [kg/m^3]
  double elastic_modulus;                        ///< of the stretched monofilament [Pa]
  double breaking_force;                         ///< tension at which it breaks at a knot, a cinch or a T-tag [N]
  double tissue_friction;                        ///< Coulomb, thread on wet tissue [dimensionless]
  double crossSection() const;                   ///< [m^2]
  double massPerLength() const;                  ///< [kg/m]
  double weightPerLength(double gravity) const;  ///< [N/m] under gravity [m/s^2]
  double axialStiffness() const;                 ///< EA: force per strain [N]
};

/// The 2-0 polypropylene monofilament of endoscopic suturing devices.
/// diameter: USP <861> allows 0.300 to 0.339 mm for size 2-0; this is the middle.
/// breaking_force: the smallest mean knot-pull strength that USP <881> accepts for a class I suture of size 2-0, 1.44
/// kgf. A given thread may be stronger, and is stronger where it is straight.
/// density: polypropylene, the middle of 900 to 910 kg/m^3 (usual range of the homopolymer).
/// elastic_modulus: 4026 MPa, mean of five blue polypropylene sutures (Nindhia et al., Int J App Pharm 2021;13 Suppl 1,
/// doi 10.22159/ijap.2021.v13s1.Y1025). Brands and sizes differ. Creep under load is neglected.
/// tissue_friction: a design choice. On wet tissue, monofilaments have less friction than braids, and their friction
/// coefficient decreases with the normal force (Zhang et al., Tribology Letters 2017;65, doi
/// 10.1007/s11249-017-0909-6). 0.15 is a usual value for lubricated polymer pairs. With it, a right-angled turn raises
/// the tension by a quarter.
ThreadMaterial polypropylene20();

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
