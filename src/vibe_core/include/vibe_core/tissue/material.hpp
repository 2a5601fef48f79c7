#pragma once

#include <string>

namespace vibe {

/// Isotropic elastic law as a function of I = tr(FtF) and J = det F. All agree with E and nu at rest. Energies are
/// given up to a constant; they are 0 at rest. Every law is continued where the formula has no value, so that energy
/// and force are finite for inverted and collapsed material and push it back: see material_law.hpp.
enum class Law {
  /// mu/2 (I - 3) - mu ln J + lambda/2 (ln J)^2
  NeoHookean,
  /// Smith, de Goes, Kim 2018, with the barrier term: ms/2 (I-3) + ls/2 (J-a)^2 - ms/2 ln(I+1)
  StableNeoHookean,
  /// Macklin, Mueller 2021: mu/2 (I-3) + lm/2 (J-g)^2, lm = lambda + mu, g = 1 + mu/lm
  MacklinMueller,
  /// mu/2 (exp(b K) - 1)/b + lambda/2 (ln J)^2, K = I - 3 - 2 ln J; b = stiffening (Fung 1967 in the invariants)
  Fung,
  /// -mu/2 Jm ln(1 - K/Jm) + lambda/2 (ln J)^2; Jm = 1/stiffening (Gent 1996)
  Gent,
  /// mu/2 (K + b/2 K^2 + b^2/6 K^3) + lambda/2 (ln J)^2: the first terms of Fung, finite everywhere (Yeoh 1993)
  Yeoh,
};

struct Material {
  Law law = Law::NeoHookean;
  double young_modulus = 0;  ///< [Pa]
  double poisson_ratio = 0;  ///< [1]
  double stiffening = 0;     ///< b, or 1/Jm; used by Fung, Gent and Yeoh [1]
};

/// Throws unless the energy of the material is positive for every deformation: E > 0; -1 < nu < 0.5, and nu >= 0 for
/// the laws with (ln J)^2, whose energy has no lower bound otherwise; stiffening >= 0, > 0 for Fung and Gent.
/// @param place  where the material was stated, for the message: "stomach.yaml:12", "tissue.wall"
/// @throws Error that names the place, the number and its range
void checkMaterial(const Material& material, const std::string& place);

}  // namespace vibe
