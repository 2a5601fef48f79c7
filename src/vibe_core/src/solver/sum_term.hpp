#pragma once

#include <array>

#include "solver/energy_term.hpp"

namespace vibe {

/// Two energies as one.
class SumTerm : public EnergyTerm {
 public:
  /// @param first, second  null: not there
  void set(const EnergyTerm* first, const EnergyTerm* second) { terms_ = {first, second}; }

  /// The one that is there where there is only one, so that it is called without a detour; null: none is.
  const EnergyTerm* simplest() const {
    if (terms_[0] != nullptr && terms_[1] != nullptr) return this;
    return terms_[0] != nullptr ? terms_[0] : terms_[1];
  }

  double evaluate(const double* positions4, float* gradient4) const override {
    double energy = 0;
    for (const EnergyTerm* term : terms_)
      if (term != nullptr) energy += term->evaluate(positions4, gradient4);
    return energy;
  }

  bool acts() const override {
    return (terms_[0] != nullptr && terms_[0]->acts()) || (terms_[1] != nullptr && terms_[1]->acts());
  }

 private:
  std::array<const EnergyTerm*, 2> terms_{{nullptr, nullptr}};
};

}  // namespace vibe
