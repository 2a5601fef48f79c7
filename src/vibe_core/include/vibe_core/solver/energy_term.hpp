#pragma once

#include <vector>

#include "vibe_core/state/stepper_memory.hpp"

namespace vibe {

/// A further energy of the nodes that a step takes into account, such as self-contact.
/// Constant during a step; node vectors are 4 numbers per node (x, y, z, 0).
class EnergyTerm {
 public:
  virtual ~EnergyTerm() = default;
  /// Adds the gradient [N] at absolute positions [m] and returns the energy [J], in double precision throughout.
  /// Finite and once differentiable wherever the positions are finite. No allocation.
  virtual double evaluate(const double* positions4, float* gradient4) const = 0;
  /// Appends the stiffness (positive semidefinite) of the energy about the positions, for the factor of later steps.
  /// The equilibrium does not depend on it, only the rate of convergence.
  virtual void addStiffness(const double* /*positions4*/, std::vector<StiffnessCoupling>& /*couplings*/) const {}
  /// Whether the energy may forbid a move that meets the constraints. False for springs, which give way.
  virtual bool acts() const { return true; }
  /// Pairs of points that it acts between, for statistics.
  virtual int pairCount() const { return 0; }
};

}  // namespace vibe
