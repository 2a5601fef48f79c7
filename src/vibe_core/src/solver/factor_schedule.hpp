#pragma once

#include "solver/stepper_scratch.hpp"

namespace vibe {

/// inertia M + margin K + foundation about positions (3 * nodes; empty: rest), fixed nodes taken out.
/// @returns false where that is not positive definite for rounding, as about a squashed state
bool factorAt(const ElasticBody& body, const std::vector<float>& positions, double inertia, double margin,
              BlockMatrix& matrix, Factor& factor);

/// Which factor a step uses is decided by the memory, a part of the state, so that a replay has the same bits; the
/// scratch provides it, from the background if it is there already.
struct FactorSchedule {
  double inertia;   ///< [1/s^2]
  double margin;    ///< times the stiffness
  int steps;        ///< from the positions to the step that uses the factor about them; 0: it stays
  double distance;  ///< a node must have moved farther for another factor [m]

  /// Lets the next factor take over where it is due, and names the positions of the one after.
  void advance(const ElasticBody& body, const MotionView& motion, StepperMemory& memory) const;
  /// The factor that the memory names, and the columns of the spots about it.
  void provide(const ElasticBody& body, const RowList<AttachmentPoint>& attachments, const StepperMemory& memory,
               StepperScratch& scratch) const;
  /// The present positions, from this step on.
  static void nameHere(const ElasticBody& body, const MotionView& motion, StepperMemory& memory);

 private:
  bool farFrom(const ElasticBody& body, const MotionView& motion, const std::vector<float>& about) const;
  void makeInBackground(const ElasticBody& body, const RowList<AttachmentPoint>& attachments,
                        const StepperMemory& memory, StepperScratch& scratch) const;
  static void provideAttachments(const ElasticBody& body, const RowList<AttachmentPoint>& attachments,
                                 StepperScratch& scratch);
};

}  // namespace vibe
