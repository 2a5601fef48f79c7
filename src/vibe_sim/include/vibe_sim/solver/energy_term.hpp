#pragma once

namespace vibe {

/// A further energy of the nodes that a step takes into account, such as walls that must not meet.
/// Constant during a step; node vectors are 4 numbers per node.
class EnergyTerm {
 public:
  virtual ~EnergyTerm() = default;
  /// Adds the gradient [N] at absolute positions [m] and returns the energy [J]. No allocation.
  virtual double evaluate(const double* positions4, float* gradient4) const = 0;
  /// Shortens, node by node, a move [m] from the positions so that nothing passes through anything.
  virtual void limitMove(const double* positions4, float* move4) const = 0;
};

}  // namespace vibe
