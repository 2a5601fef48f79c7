#pragma once

#include <memory>
#include <string>

#include "vibe_core/scene/tissue_choices.hpp"

namespace vibe {

/// Isotropic elastic law: energy per rest volume as a function of I = tr(FtF) and J = det F.
/// scene/tissue_choices.hpp lists the formulas, where K = I - 3 - 2 ln J, b is the stiffening, and mu and lambda are
/// the Lame constants that follow from Young's modulus and Poisson's ratio. All laws agree with these two at rest.
/// Energies are given up to a constant; they are 0 at rest. Where a formula is undefined (J <= 0, K beyond Gent's
/// limit) it is extended such that energy and force stay finite for inverted and collapsed material and the force
/// restores it: see tissue/law_terms.hpp.
enum class Law {
/// One line of the list of laws as an enumerator.
#define VIBE_ENUMERATOR(name, word, formula) name,
  VIBE_MATERIAL_LAWS(VIBE_ENUMERATOR)
#undef VIBE_ENUMERATOR
};

/// One line of the list of laws as a number to be added.
#define VIBE_COUNT(name, word, formula) +1  // NOLINT(bugprone-macro-parentheses): a summand
/// Number of built-in laws. Laws of other packages have this number and higher ones: see registerMaterialLaw().
constexpr int kLawCount = VIBE_MATERIAL_LAWS(VIBE_COUNT);
#undef VIBE_COUNT

struct Material {
  Law law = Law::NeoHookean;  ///< built in, or registered before
  double young_modulus = 0;   ///< [Pa]
  double poisson_ratio = 0;   ///< ratio
  double stiffening = 0;      ///< b, or 1/Jm; not used by every law (ratio)
};

/// Parameter ranges of a law beyond E > 0, 0 <= nu < 0.5 and stiffening >= 0.
struct LawLimits {
  bool negative_poisson_ratio = false;  ///< also allows -1 < nu < 0: the energy is bounded from below there
  bool needs_stiffening = false;        ///< requires stiffening > 0
};

/// Throws unless the energy of the material is positive for every deformation: E > 0; -1 < nu < 0.5, and nu >= 0 and
/// stiffening > 0 where the LawLimits of the law require them; stiffening >= 0.
/// @param place  where the material was specified, for the message: "stomach.yaml:12", "tissue.wall"
/// @throws Error that names the place, the value and its range
void checkMaterial(const Material& material, const std::string& place);

/// The law with the given name in tissue.law.
/// @throws Error for an unknown name; lists the nearest or all known names
Law lawByName(const std::string& name);

/// The name of a law in tissue.law.
std::string nameOf(Law law);

/// Invariants of a deformation, as differences from rest.
struct LawInvariants {
  double first;       ///< I - 3 = tr(FtF) - 3 = l1^2 + l2^2 + l3^2 - 3 for principal stretches l (ratio)
  double volume;      ///< J - 1 = l1 l2 l3 - 1; below -1 for inverted material (ratio)
  double difference;  ///< first - 2 volume, computed without cancellation; second order in the strain
};

/// Parameters of a material. shear and lambda are the Lame constants that follow from young_modulus and poisson_ratio.
struct LawParameters {
  double shear;       ///< mu = E / (2 (1 + nu)) [Pa]
  double lambda;      ///< E nu / ((1 + nu) (1 - 2 nu)) [Pa]
  double stiffening;  ///< tissue.stiffening; a law may ignore it (ratio)
};

/// Energy per rest volume W(I, J) and its derivatives with respect to I and J [Pa].
struct LawDerivatives {
  double energy;               ///< W [Pa]
  double by_i, by_j;           ///< dW/dI, dW/dJ [Pa]
  double by_ii, by_ij, by_jj;  ///< d2W/dI2, d2W/dI dJ, d2W/dJ2 [Pa]
};

/// An elastic law defined in another package. Once registered, scenes and benchmark cases refer to it by name like a
/// built-in law, and shells and everything that evaluates a MaterialEnergy use it. It is evaluated triangle by triangle
/// in double precision, while the built-in laws are compiled into kernels for several triangles at once; see
/// CONTRIBUTING.md for the difference in speed.
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

struct LawConstants;

/// Energy per rest volume W(I, J) of a material and its derivatives [Pa]. `balance` is W_J + 2 W_I, which is 0 at rest:
/// with it the stress 2 W_I F + W_J cof F = 2 W_I (F - cof F) + balance cof F has no large terms that cancel.
template <class Real>
struct EnergyDerivatives {
  Real energy;               ///< W [Pa]
  Real by_i, by_j, balance;  ///< dW/dI, dW/dJ, and dW/dJ + 2 dW/dI [Pa]
  Real by_ii, by_ij, by_jj;  ///< d2W/dI2, d2W/dI dJ, d2W/dJ2 [Pa]
};

/// The law of a material at any deformation, for elements outside this library. The arguments are the invariants of
/// LawInvariants: `first` is I - 3, `volume` is J - 1, and `difference` is first - 2 volume, to be computed without
/// cancellation. All results are finite for every deformation. Constant after building; any thread may call it.
class MaterialEnergy {
 public:
  /// @throws Error as checkMaterial(), with the place "the material"
  explicit MaterialEnergy(const Material& material);

  /// In double precision.
  EnergyDerivatives<double> at(double first, double volume, double difference) const;
  /// In single precision, with the bits of the shells in fused arithmetic, whatever the arithmetic of this process is.
  EnergyDerivatives<float> at(float first, float volume, float difference) const;

 private:
  Law law_;
  std::shared_ptr<const LawConstants> constants_;
};

}  // namespace vibe
