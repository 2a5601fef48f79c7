#pragma once

namespace vibe {

/// What a suture thread is made of. SI units.
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
/// diameter: USP <861> allows 0.300 to 0.339 mm for size 2-0, the middle is taken.
/// breaking_force: the least mean knot-pull strength that USP <881> accepts of a class I suture of size 2-0, 1.44 kgf;
/// a given thread may hold more, and holds more where it is straight. density: polypropylene, the middle of 900 to 910
/// kg/m^3 (usual range of the homopolymer). elastic_modulus: 4026 MPa, mean of five blue polypropylene sutures (Nindhia
/// et al., Int J App Pharm 2021;13 Suppl 1, doi 10.22159/ijap.2021.v13s1.Y1025); makes and sizes differ, and the thread
/// creeps under load, which is left out. tissue_friction: a design choice. On wet tissue monofilaments rub less than
/// braids, and less the harder they press (Zhang et al., Tribology Letters 2017;65, doi 10.1007/s11249-017-0909-6);
/// 0.15 is a usual value of lubricated polymer pairs. A right-angled turn then raises the tension by a quarter.
ThreadMaterial polypropylene20();

}  // namespace vibe
