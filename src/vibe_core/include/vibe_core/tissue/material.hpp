#pragma once

#include <string>

#include "vibe_core/scene/material_law_list.hpp"

namespace vibe {

/// Isotropic elastic law: energy per volume at rest as a function of I = tr(FtF) and J = det F, with the formulas of
/// scene/material_law_list.hpp, where K = I - 3 - 2 ln J, b is the stiffening, and mu and lambda are Lame's constants
/// of Young's modulus and Poisson's ratio. All laws agree with these two at rest. Energies are given up to a constant;
/// they are 0 at rest. Where a formula has no value (J <= 0, K beyond Gent's limit) it is continued, so that energy
/// and force are finite for inverted and collapsed material and push it back: see tissue/law_terms.hpp.
enum class Law {
#define VIBE_ENUMERATOR(name, word, formula) name,
  VIBE_MATERIAL_LAWS(VIBE_ENUMERATOR)
#undef VIBE_ENUMERATOR
};

/// Number of laws of the library. Laws of other packages have this number and those above: see material_registry.hpp.
#define VIBE_COUNT(name, word, formula) +1
constexpr int kLawCount = VIBE_MATERIAL_LAWS(VIBE_COUNT);
#undef VIBE_COUNT

struct Material {
  Law law = Law::NeoHookean;
  double young_modulus = 0;  ///< [Pa]
  double poisson_ratio = 0;  ///< [1]
  double stiffening = 0;     ///< b, or 1/Jm; not used by every law [1]
};

/// Which parameters a law takes beyond E > 0, 0 <= nu < 0.5 and stiffening >= 0.
struct LawLimits {
  bool negative_poisson_ratio = false;  ///< -1 < nu < 0 too: the energy is bounded from below there
  bool needs_stiffening = false;        ///< stiffening > 0
};

/// Throws unless the energy of the material is positive for every deformation: E > 0; -1 < nu < 0.5, and nu >= 0 and
/// stiffening > 0 as the LawLimits of the law say; stiffening >= 0.
/// @param place  where the material was stated, for the message: "stomach.yaml:12", "tissue.wall"
/// @throws Error that names the place, the number and its range
void checkMaterial(const Material& material, const std::string& place);

/// The law that a word of tissue.law names.
/// @throws Error for an unknown one, with the nearest or all known ones
Law lawByName(const std::string& name);

/// The word that names a law.
std::string nameOf(Law law);

}  // namespace vibe
