#include "vibe_core/tissue/material.hpp"

#include <cmath>
#include <sstream>

#include "tissue/material_law.hpp"
#include "vibe_core/common/error.hpp"

namespace vibe {
namespace {

LawLimits limitsOf(Law law) {
  if (const MaterialLaw* registered = registeredLaw(law)) return registered->limits();
  return withLaw(law, [](auto tag) { return LawFormula<decltype(tag)::value>::kLimits; });
}

/// Names of the laws with the given value of a flag in their limits.
std::string lawsWith(bool LawLimits::*flag, bool set) {
  std::string names;
  for (int k = 0; k < kLawCount; ++k) {
    const Law law = static_cast<Law>(k);
    if (limitsOf(law).*flag == set) names += (names.empty() ? "" : ", ") + nameOf(law);
  }
  return names;
}

[[noreturn]] void reject(const std::string& place, const char* name, double value, const std::string& range) {
  std::ostringstream message;
  message << place << ": " << name << " is " << value << ", but must be " << range << '.';
  throw Error(message.str());
}

}  // namespace

void checkMaterial(const Material& material, const std::string& place) {
  const double e = material.young_modulus, nu = material.poisson_ratio, b = material.stiffening;
  if (static_cast<int>(material.law) >= kLawCount && registeredLaw(material.law) == nullptr)
    throw Error(place + ": the law has a number that no law has; use lawByName() or registerMaterialLaw().");
  const LawLimits limits = limitsOf(material.law);
  if (!(e > 0) || !std::isfinite(e)) reject(place, "Young's modulus", e, "a finite number above 0 Pa");
  if (!(nu > -1 && nu < 0.5)) reject(place, "Poisson's ratio", nu, "above -1 and below 0.5");
  if (nu < 0 && !limits.negative_poisson_ratio)
    reject(place, "Poisson's ratio", nu,
           "0 or more for this law (allowed below 0: " + lawsWith(&LawLimits::negative_poisson_ratio, true) + ")");
  if (!(b >= 0) || !std::isfinite(b)) reject(place, "the stiffening", b, "a finite number, 0 or more");
  if (b == 0 && limits.needs_stiffening)
    reject(place, "the stiffening", b, "above 0 for the law " + nameOf(material.law) + " (neo_hookean is without it)");
}

LawConstants lawConstants(const Material& material) {
  checkMaterial(material, "the material");
  const double nu = material.poisson_ratio;
  const double mu = material.young_modulus / (2 * (1 + nu));
  const double lambda = 2 * mu * nu / (1 - 2 * nu);
  return withLaw(material.law, [&](auto tag) {
    using Formula = LawFormula<decltype(tag)::value>;
    LawConstants constants = Formula::constants(mu, lambda, material.stiffening, Formula::kLimit);
    constants.registered = registeredLaw(material.law);
    return constants;
  });
}

}  // namespace vibe
