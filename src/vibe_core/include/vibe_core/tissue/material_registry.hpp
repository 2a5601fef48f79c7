#pragma once

#include <memory>
#include <string>

#include "vibe_core/tissue/material.hpp"

namespace vibe {

/// Invariants of a deformation, as differences from rest.
struct LawInvariants {
  double first;       ///< I - 3 = tr(FtF) - 3 = l1^2 + l2^2 + l3^2 - 3 for principal stretches l [1]
  double volume;      ///< J - 1 = l1 l2 l3 - 1; below -1 for inverted material [1]
  double difference;  ///< first - 2 volume, computed without cancellation; second order in the strain [1]
};

/// Parameters of a material. shear and lambda are the Lame constants that follow from young_modulus and poisson_ratio.
struct LawParameters {
  double shear;       ///< mu = E / (2 (1 + nu)) [Pa]
  double lambda;      ///< E nu / ((1 + nu) (1 - 2 nu)) [Pa]
  double stiffening;  ///< tissue.stiffening; a law may ignore it [1]
};

/// Energy per rest volume W(I, J) and its derivatives with respect to I and J [Pa].
struct LawDerivatives {
  double energy;
  double by_i, by_j;
  double by_ii, by_ij, by_jj;
};

/// An elastic law defined in another package. Once registered, scenes and benchmark cases refer to it by name like a
/// built-in law, and shells and everything that evaluates a MaterialEnergy use it. It is evaluated triangle by triangle in double precision, while the
/// built-in laws are compiled into kernels for several triangles at once; see CONTRIBUTING.md for the difference in
/// speed.
///
/// The energy must be 0 at rest and agree with the parameters there (W_J + 2 W_I = 0, 2 W_I = mu, 4 W_II + 4 W_IJ +
/// W_JJ - 2 W_I = lambda). It and all derivatives must be finite for every I and J, including J <= 0.
class MaterialLaw {
 public:
  virtual ~MaterialLaw() = default;

  /// The formula as one line of text.
  virtual std::string formula() const = 0;
  /// Parameter ranges of the law.
  virtual LawLimits limits() const { return {}; }
  /// Called from several threads at once; must not throw.
  virtual LawDerivatives at(const LawParameters& parameters, const LawInvariants& deformation) const = 0;
};

/// Registers a law under a name for tissue.law, for the rest of the program. Call it before the scene is read.
/// @throws Error if the name is not usable (see addChoice()) or the law violates a rule above. The check covers the
///         values at rest, the derivatives against finite differences, and finite results for inverted material
Law registerMaterialLaw(const std::string& name, std::shared_ptr<const MaterialLaw> law);

}  // namespace vibe
