#pragma once

namespace vibe {

/// A further energy of the nodes that a step takes into account, such as self-contact.
/// Constant during a step; node vectors are 4 numbers per node (x, y, z, 0).
class EnergyTerm {
 public:
  virtual ~EnergyTerm() = default;
  /// Adds the gradient [N] at absolute positions [m] and returns the energy [J], in double precision throughout.
  /// Finite and once differentiable wherever the positions are finite. No allocation.
  virtual double evaluate(const double* positions4, float* gradient4) const = 0;
  /// Whether the energy may forbid a move that meets the constraints. False for springs, which give way.
  virtual bool acts() const { return true; }
};

}  // namespace vibe
