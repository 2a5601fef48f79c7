#include "vibe_core/tissue/material.hpp"

#include <cmath>
#include <limits>
#include <sstream>

#include "tissue/material_law.hpp"
#include "vibe_core/common/error.hpp"

namespace vibe {
namespace {

bool hasLogOfVolume(Law law) {
  return law != Law::StableNeoHookean && law != Law::MacklinMueller;
}

// of K times the stiffening
double profileLimit(Law law) {
  if (law == Law::Fung) return kFungLimit;
  if (law == Law::Gent) return kGentLimit;
  if (law == Law::Yeoh) return kYeohLimit;
  return std::numeric_limits<double>::infinity();
}

[[noreturn]] void reject(const std::string& place, const char* name, double value, const char* range) {
  std::ostringstream message;
  message << place << ": " << name << " is " << value << ", but must be " << range << '.';
  throw Error(message.str());
}

}  // namespace

void checkMaterial(const Material& material, const std::string& place) {
  const double e = material.young_modulus, nu = material.poisson_ratio, b = material.stiffening;
  if (!(e > 0) || !std::isfinite(e)) reject(place, "Young's modulus", e, "a finite number above 0 Pa");
  if (!(nu > -1 && nu < 0.5)) reject(place, "Poisson's ratio", nu, "above -1 and below 0.5");
  if (nu < 0 && hasLogOfVolume(material.law))
    reject(place, "Poisson's ratio", nu,
           "0 or more for this law (the stable neo-Hookean and the Macklin-Mueller law allow less)");
  if (!(b >= 0) || !std::isfinite(b)) reject(place, "the stiffening", b, "a finite number, 0 or more");
  if (b == 0 && (material.law == Law::Fung || material.law == Law::Gent))
    reject(place, "the stiffening", b, "above 0 for the laws of Fung and Gent (neo-Hookean is the law without it)");
}

LawConstants lawConstants(const Material& material) {
  checkMaterial(material, "the material");
  const double nu = material.poisson_ratio;
  const double mu = material.young_modulus / (2 * (1 + nu));
  const double lambda = 2 * mu * nu / (1 - 2 * nu);
  if (material.law == Law::StableNeoHookean) return {4.0 / 3 * mu, lambda + 5.0 / 6 * mu, 0, 0};
  if (material.law == Law::MacklinMueller) return {mu, lambda + mu, 0, 0};
  const double b = material.stiffening;
  const double limit = b > 0 ? profileLimit(material.law) / b : std::numeric_limits<double>::infinity();
  return {mu, lambda, b, limit};
}

}  // namespace vibe
