#pragma once

#include <memory>

#include "vibe_core/tissue/material.hpp"

namespace vibe {

struct LawConstants;

/// Energy per rest volume W(I, J) of a material and its derivatives [Pa]. `balance` is W_J + 2 W_I, which is 0 at rest:
/// with it the stress 2 W_I F + W_J cof F = 2 W_I (F - cof F) + balance cof F has no large terms that cancel.
template <class Real>
struct EnergyDerivatives {
  Real energy;
  Real by_i, by_j, balance;
  Real by_ii, by_ij, by_jj;
};

/// The law of a material at any deformation, for elements outside this library. The arguments are the invariants of
/// LawInvariants: `first` is I - 3, `volume` is J - 1, and `difference` is first - 2 volume, to be computed without
/// cancellation. All results are finite for every deformation. Constant after building; any thread may call it.
class MaterialEnergy {
 public:
  /// @throws Error as checkMaterial(), with the place "the material"
  explicit MaterialEnergy(const Material& material);

  EnergyDerivatives<double> at(double first, double volume, double difference) const;
  /// In single precision, with the bits of the shells in fused arithmetic, whatever the arithmetic of this process is.
  EnergyDerivatives<float> at(float first, float volume, float difference) const;

 private:
  Law law_;
  std::shared_ptr<const LawConstants> constants_;
};

}  // namespace vibe
