#include "vibe_core/tissue/material_energy.hpp"

#include "tissue/material_law.hpp"

namespace vibe {

MaterialEnergy::MaterialEnergy(const Material& material)
    : law_(material.law), constants_(std::make_shared<const LawConstants>(lawConstants(material))) {}

EnergyDerivatives<double> MaterialEnergy::at(double first, double volume, double difference) const {
  const LawTerms<double> terms(*constants_);
  const auto w = withLaw(law_, [&](auto tag) { return lawAt<decltype(tag)::value>(terms, first, volume, difference); });
  return {w.energy, w.by_i, w.by_j, w.balance, w.by_ii, w.by_ij, w.by_jj};
}

EnergyDerivatives<float> MaterialEnergy::at(float first, float volume, float difference) const {
  const LawTerms<FusedFloats> terms(*constants_);
  const FusedFloats i(first), j(volume), even(difference);
  const auto w = withLaw(law_, [&](auto tag) { return lawAt<decltype(tag)::value>(terms, i, j, even); });
  return {w.energy.get(0), w.by_i.get(0),  w.by_j.get(0), w.balance.get(0),
          w.by_ii.get(0),  w.by_ij.get(0), w.by_jj.get(0)};
}

}  // namespace vibe
