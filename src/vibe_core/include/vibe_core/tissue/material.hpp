#pragma once

#include <string>

#include "vibe_core/scene/material_law_list.hpp"

namespace vibe {

/// Isotropic elastic law: energy per rest volume as a function of I = tr(FtF) and J = det F.
/// scene/material_law_list.hpp lists the formulas, where K = I - 3 - 2 ln J, b is the stiffening, and mu and lambda are
/// the Lame constants that follow from Young's modulus and Poisson's ratio. All laws agree with these two at rest.
/// Energies are given up to a constant; they are 0 at rest. Where a formula is undefined (J <= 0, K beyond Gent's
/// limit) it is extended such that energy and force stay finite for inverted and collapsed material and the force
/// restores it: see tissue/law_terms.hpp.
enum class Law {
#define VIBE_ENUMERATOR(name, word, formula) name,
  VIBE_MATERIAL_LAWS(VIBE_ENUMERATOR)
#undef VIBE_ENUMERATOR
};

/// Number of built-in laws. Laws of other packages have this number and higher ones: see material_registry.hpp.
#define VIBE_COUNT(name, word, formula) +1
constexpr int kLawCount = VIBE_MATERIAL_LAWS(VIBE_COUNT);
#undef VIBE_COUNT

struct Material {
  Law law = Law::NeoHookean;
  double young_modulus = 0;  ///< [Pa]
  double poisson_ratio = 0;  ///< [1]
  double stiffening = 0;     ///< b, or 1/Jm; not used by every law [1]
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

}  // namespace vibe
