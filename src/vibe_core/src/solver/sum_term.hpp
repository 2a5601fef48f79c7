#pragma once

#include <vector>

#include "vibe_core/solver/energy_term.hpp"

namespace vibe {

/// Several energies as one, added in the order in which they were given.
class SumTerm : public EnergyTerm {
 public:
  void clear() { terms_.clear(); }
  /// @param term  null: nothing is added
  void add(const EnergyTerm* term) {
    if (term != nullptr) terms_.push_back(term);
  }

  /// The only term if there is one, so that it is called directly; null without terms.
  const EnergyTerm* simplest() const {
    if (terms_.size() > 1) return this;
    return terms_.empty() ? nullptr : terms_.front();
  }

  double evaluate(const double* positions4, float* gradient4) const override {
    double energy = 0;
    for (const EnergyTerm* term : terms_) energy += term->evaluate(positions4, gradient4);
    return energy;
  }

  void addStiffness(const double* positions4, std::vector<StiffnessCoupling>& couplings) const override {
    for (const EnergyTerm* term : terms_) term->addStiffness(positions4, couplings);
  }

  bool acts() const override {
    for (const EnergyTerm* term : terms_)
      if (term->acts()) return true;
    return false;
  }

  int pairCount() const override {
    int sum = 0;
    for (const EnergyTerm* term : terms_) sum += term->pairCount();
    return sum;
  }

 private:
  std::vector<const EnergyTerm*> terms_;
};

}  // namespace vibe
