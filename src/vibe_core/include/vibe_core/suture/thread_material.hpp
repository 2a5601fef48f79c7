#pragma once

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

}  // namespace vibe
