#pragma once

#include "solver/stepper_workspace.hpp"

namespace vibe {

/// What a factor is about.
struct FactorPoint {
  const std::vector<float>& positions;  ///< (3 * nodes) [m]; empty: rest
  const std::vector<StiffnessCoupling>& couplings;
};

/// inertia M + margin K + foundation + couplings, fixed nodes taken out.
/// @param plan    of the elements; the factor gets the one that belongs to the couplings
/// @param factor  its plan is kept if it is that of the couplings already
/// @returns false where that is not positive definite for rounding, as about a squashed state
bool factorAt(const ElasticBody& body, const FactorPoint& point, double inertia, double margin,
              const std::shared_ptr<const FactorPlan>& plan, BlockMatrix& matrix, Factor& factor);
/// The same without couplings, for a factor whose plan has none.
bool factorAt(const ElasticBody& body, const std::vector<float>& positions, double inertia, double margin,
              BlockMatrix& matrix, Factor& factor);

/// Which factor a step uses is decided by the memory, a part of the state, so that a replay has the same bits; the
/// scratch provides it, from the background if it is there already.
struct FactorSchedule {
  double inertia;   ///< [1/s^2]
  double margin;    ///< times the stiffness of the elements
  int steps;        ///< from the positions to the step that uses the factor about them; 0: it stays
  double distance;  ///< a node must have moved farther for another factor [m]
  double gain = 1;  ///< of the rows' values over positions, see setStepTargets()

  /// Lets the next factor take over where it is due, and names the positions and couplings of the one after.
  void advance(const ElasticBody& body, const MotionView& motion, const BodyLoads& loads, StepperMemory& memory,
               StepperWorkspace& scratch) const;
  /// The factor that the memory names, and the columns of the spots about it.
  void provide(const ElasticBody& body, const BodyLoads& loads, const StepperMemory& memory,
               StepperWorkspace& scratch) const;
  /// What StepperWorkspace::task says, in the background.
  static void makeNext(StepperWorkspace& scratch);
  /// The present positions, without couplings, from this step on.
  static void nameHere(const ElasticBody& body, const MotionView& motion, StepperMemory& memory);

 private:
  bool farFrom(const ElasticBody& body, const MotionView& motion, const std::vector<float>& about) const;
  void factorSafely(const ElasticBody& body, const FactorPoint& point, const std::shared_ptr<const FactorPlan>& plan,
                    BlockMatrix& matrix, Factor& factor) const;
  void makeInBackground(const ElasticBody& body, const BodyLoads& loads, const StepperMemory& memory,
                        StepperWorkspace& scratch) const;
};

/// Stiffness that the loads add at positions (4 per node) [m].
/// @param gain  of the rows' values over positions, see setStepTargets(); 1 in an equilibrium
void collectCouplings(const BodyLoads& loads, const double* positions4, double gain,
                      std::vector<StiffnessCoupling>& couplings);

}  // namespace vibe
