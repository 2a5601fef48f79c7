#pragma once

#include <limits>

#include "solver/potential.hpp"
#include "vibe_core/solver/step_ways.hpp"

namespace vibe {

/// Iterations of L-BFGS on top of the scratch's factor towards the minimum of a potential under the scratch's rows. The
/// direction is that of the two-loop recursion with the factor, rows and gas eliminated, as the initial inverse
/// (Nocedal 1980, doi 10.1090/S0025-5718-1980-0572855-7); the search along it is that of Armijo, with the approximate
/// Wolfe condition where rounding hides a decrease (Hager, Zhang 2005, doi 10.1137/030601880).
class QuasiNewton {
 public:
  /// @param safe_length      a last move shorter than this is not verified [m]
  /// @param max_evaluations  of the potential, after which it is exhausted
  QuasiNewton(const ElasticBody& body, Potential& potential, BodyLoads& loads, StepperWorkspace& scratch,
              double safe_length = 0, int max_evaluations = std::numeric_limits<int>::max());

  /// Evaluates at the scratch's z.
  void start();
  /// The same where that is known: with the value and the scratch's gradient of another start() there.
  void start(double value);
  /// Eliminates the gas with the stiffness that it has at a foreseen volume. Where an insufflator's law turns out to
  /// have another, iterations change it.
  void setGas(double volume);
  /// Convergence is judged by a length instead of that of the first direction; 0: by that one [m].
  void judgeBy(double length) { first_length_ = length; }
  /// That length, after the first direction [m].
  double referenceLength() const { return first_length_; }
  /// Forgets the history; needed after a new factor.
  void restart() { history_.count = 0; }
  /// Finds the direction that the next iterate takes, if it is not known yet.
  void aim();
  /// Where that leads.
  const std::vector<double>& foreseen();
  /// Takes the scratch's rows: once they are built, and again when others count, before anything moves.
  void takeRows();
  /// One step: direction, then as much of it as lowers the energy.
  /// @param max     no node moves farther [m]
  /// @param verify  false: the end point is not evaluated if the move is safe, because it is short or
  ///                because the iteration is contracting (then no more iterations may follow)
  /// @returns how far a node moved at most [m]
  double iterate(double max, bool verify);
  /// Moves to where the conditions hold, if they do not yet and no walls are near. The history is lost.
  /// @returns whether it moved; then more iterations must follow
  bool satisfyConstraints();
  /// Length of the full direction of the last iterate [m].
  double directionLength() const { return direction_length_; }
  double safeLength() const { return safe_length_; }  ///< see the constructor [m]
  double value() const { return value_; }
  /// Rounding error of the displacements, which are single precision [m].
  double resolution() const;
  /// The last direction is less than half of the one before and leaves a hundredth of the first, or it is the first
  /// and has a safe length.
  bool contracts() const { return contracts_; }
  /// The last iterate found no lower energy along its direction, and did not move.
  bool failed() const { return failed_; }
  /// After a failure: forgets the history, if there is any, so that the next iterate takes another direction.
  bool startAgain();
  bool exhausted() const { return evaluations_ >= max_evaluations_; }
  int evaluations() const { return evaluations_; }
  int solves() const { return solves_; }
  /// Which ways the iterations have taken.
  const StepWays& ways() const { return ways_; }
  /// How far the next iterate would move a node: the last direction times the rate at which directions shrink, or the
  /// last direction where no rate is known [m].
  double residual() const;

 private:
  void findDirection();
  bool changeGas();
  double swelling() const;
  void loadWork();
  void applyInverse(const double* alpha);
  void rowResidual();
  bool rowsStay() const;
  void addRowForces(double sign, std::vector<float>& vector) const;
  double lagrangian(double part) const;
  double lagrangianSlope(double part) const;
  double evaluate(const std::vector<double>& z, std::vector<float>& gradient);
  double rest() const;
  double advance(double max, bool verify);
  void takeUnseen();
  double slopeAtTrial(double part) const;
  double search(double part);
  void keepPair(double part);
  void setTrial(double part);

  const ElasticBody& body_;
  Potential& potential_;
  GasLoad& gas_;
  const EnergyTerm* extra_;
  StepperWorkspace& scratch_;
  Iterate& at_;
  PairHistory& history_;
  RowSystem& system_;
  RowUnknowns& unknowns_;
  double safe_length_;
  int max_evaluations_;
  int evaluations_ = 0, solves_ = 0;
  StepWays ways_;
  double value_ = 0;
  GasLaw::Piece gas_piece_ = GasLaw::Piece::Kept;
  double direction_length_ = 0, last_length_ = -1, before_length_ = -1;
  double slope_ = 0;
  double first_length_ = 0;
  bool aimed_ = false, failed_ = false, contracts_ = false;
};

}  // namespace vibe
