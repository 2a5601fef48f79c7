#pragma once

#include <memory>
#include <string>

#include "vibe_core/tissue/material.hpp"

namespace vibe {

/// A deformation by its invariants, as differences to rest.
struct LawInvariants {
  double first;       ///< I - 3 = tr(FtF) - 3 = l1^2 + l2^2 + l3^2 - 3 for principal stretches l [1]
  double volume;      ///< J - 1 = l1 l2 l3 - 1; below -1 for inverted material [1]
  double difference;  ///< first - 2 volume, without cancellation: of second order in the strain [1]
};

/// Parameters of a material. shear and lambda are Lame's constants of young_modulus and poisson_ratio.
struct LawParameters {
  double shear;       ///< mu = E / (2 (1 + nu)) [Pa]
  double lambda;      ///< E nu / ((1 + nu) (1 - 2 nu)) [Pa]
  double stiffening;  ///< tissue.stiffening, for the law to use or not [1]
};

/// Energy per volume at rest W(I, J) and its derivatives by I and J [Pa].
struct LawDerivatives {
  double energy;
  double by_i, by_j;
  double by_ii, by_ij, by_jj;
};

/// An elastic law of another package. Once registered, scenes and benchmark cases name it like those of the library,
/// and shells and tetrahedra use it. It is evaluated triangle by triangle in double precision, while the laws of the
/// library are compiled into kernels for several triangles at once; see CONTRIBUTING.md for the difference in speed.
///
/// The energy must be 0 at rest, agree with the parameters there (W_J + 2 W_I = 0, 2 W_I = mu,
/// 4 W_II + 4 W_IJ + W_JJ - 2 W_I = lambda) and be finite, with all derivatives, for every I and J, J <= 0 included.
class MaterialLaw {
 public:
  virtual ~MaterialLaw() = default;

  /// The formula, in one line for people.
  virtual std::string formula() const = 0;
  /// Which parameters it takes.
  virtual LawLimits limits() const { return {}; }
  /// Called from several threads at once; must not throw.
  virtual LawDerivatives at(const LawParameters& parameters, const LawInvariants& deformation) const = 0;
};

/// Makes a law known under a word of tissue.law, for the rest of the program. Call it before the scene is read.
/// @throws Error if the word is not usable (see addChoice()) or the law breaks a rule above: its values are checked at
/// rest, its derivatives against differences, and inverted material for finite numbers
Law registerMaterialLaw(const std::string& name, std::shared_ptr<const MaterialLaw> law);

}  // namespace vibe
