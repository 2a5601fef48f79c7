#pragma once

#include <cstddef>

namespace vibe {

/// A term of the series of a wall that relaxes, for steps of one length.
struct PronyTerm {
  float ratio;                   ///< of the stress, which relaxes in the end
  float ahead;                   ///< of the overstress, to where the forces of a step act
  float decay, gain;             ///< of the overstress over a step, and by the change of the law's stress
  double held_decay, held_gain;  ///< of the energy that it holds, and by the work done on it
};

/// Stress and strain of a wall, as ShellElements::stress() gives them.
struct RelaxationSweep {
  std::size_t size;                   ///< of each, whole batches
  const float *law, *strain;          ///< at the start of the step [N/m], [m^2]
  const float *law_end, *strain_end;  ///< at its end; for advance() only
};

/// Sums are in single precision over the numbers of a triangle, in double over triangles. No operation is fused, and
/// both sets have the same bits.
struct RelaxationKernel {
  /// Writes minus what has relaxed, where the forces of the step act. @param overstress  (terms * size) [N/m]
  /// @returns its work from rest to the start of the step [J]
  double (*relaxed)(const RelaxationSweep& sweep, const PronyTerm* term, std::size_t terms, const float* overstress,
                    float* out);
  /// Takes a term to the end of the step. @param overstress  (size) of the term [N/m]
  /// @returns the work of what had relaxed of it on the wall [J]
  double (*advance)(const RelaxationSweep& sweep, const PronyTerm& term, float* overstress);
};
RelaxationKernel relaxationKernelSse2();
RelaxationKernel relaxationKernelAvx2();  ///< call its functions only on a machine that has the instructions

}  // namespace vibe
