#pragma once

#include <vector>

#include "vibe_core/sparse/block_matrix.hpp"

namespace vibe {

/// The stored energy of an elastic body as a function of its node displacements: the interface for implicit solvers.
/// Constant after building. Node vectors are 4 floats per node, so that one 128-bit load fetches a node: x, y, z, and
/// the contraction of its muscle in displacements (0 or more, ratio), unused in others. Displacements from rest instead
/// of positions keep single precision accurate to a strain of 1e-7. The work is divided into a fixed number of pieces.
/// Each adds to its own output, and the outputs are summed in order, so the result does not depend on the number of
/// threads.
class ElasticElements {
 public:
  virtual ~ElasticElements() = default;

  virtual int nodeCount() const = 0;   ///< of the whole body, fixed nodes included
  virtual int pieceCount() const = 0;  ///< number of pieces, which does not depend on the number of threads

  /// Adds the energy gradient [N] of one piece at the displacements (m) and returns its energy [J]. No allocation.
  /// @param displacement4, gradient4  (4 * nodeCount)
  virtual double evaluate(int piece, const float* displacement4, float* gradient4) const = 0;

  /// Energy [J] and gradient in double precision, for references and tests; interleaved (3 * nodeCount), overwritten.
  virtual double evaluate(const double* displacement, double* gradient) const = 0;

  /// Groups of coupled nodes, for the pattern of the stiffness; see blockPattern.
  virtual std::vector<std::pair<const std::vector<int>*, int>> nodeGroups() const = 0;

  /// Adds a positive semidefinite approximation of the Hessian [N/m] at a displacement. It is exact where the Hessian
  /// is positive semidefinite or nearly so. Interleaved (3 * nodeCount).
  virtual void addStiffness(const double* displacement, BlockMatrix& stiffness) const = 0;

  /// Mass of each node for a density [kg/m^3], lumped; (nodeCount).
  virtual std::vector<double> lumpedMass(double density) const = 0;

  /// Mean stretch around each node relative to rest, minus 1; within the surface for shells. (nodeCount)
  virtual void strain(const double* displacement, float* out) const = 0;
};

}  // namespace vibe
