#pragma once

#include <Eigen/Core>
#include <array>

#include "solver/constraint_rows.hpp"

namespace vibe {

class ConstraintSchur;

/// Unknowns of QuasiNewton beside those of the tissue: how far rows give way to their own forces, because a tool
/// yields, or a contact or a thread has a compliance. Where they give way by p = -C f, they have the energy
/// p C^-1 p / 2. All is kept as the forces f, those on the degrees of freedom of the tool and then one per row: so C
/// may be singular, and the scalar product of a move with a change of gradient is f C g.
class RowUnknowns {
 public:
  static constexpr int kHistory = 6;  ///< pairs of moves and changes of the gradient

  /// No row has given way. Keeps its buffers.
  /// @param rows  must live until the next begin()
  void begin(const ConstraintRows& rows);

  /// Before the first loop over pairs, with the forces of the last elimination.
  void beginDirection(const ConstraintSchur& schur);
  /// Share of pair i in the scalar product of its move and the gradient.
  double gradientTerm(int i) const { return product(pair_[static_cast<std::size_t>(i)], left_); }
  /// The first loop takes `part` of the change of pair i from the gradient.
  void subtract(int i, double part);
  /// Makes rows' targets for the tissue of those that the first loop leaves.
  void addTargets(Eigen::VectorXd& rhs) const { addMotion(-1, taken_, rhs); }
  /// The direction of the elimination.
  /// @param moves  out: how far the rows' values move in it, beyond what the rows give way
  void setDirection(const ConstraintSchur& schur, Eigen::VectorXd& moves);
  /// Share of pair i in the scalar product of its change and the direction.
  double directionTerm(int i) const { return product(pair_[static_cast<std::size_t>(i)], direction_); }
  /// The second loop takes `part` of the move of pair i from the direction.
  void reduce(int i, double part) { direction_ -= part * pair_[static_cast<std::size_t>(i)]; }

  /// From how far rows are from their targets without forces to how far they are now.
  void addDisplacement(Eigen::VectorXd& rhs) const { addMotion(-1, force_, rhs); }
  /// Takes a part of the direction.
  void move(double part) { force_ += part * direction_; }
  /// Gives way by the forces of the last elimination in addition.
  void push(const ConstraintSchur& schur);
  /// Energy, and its slope, after a part of the direction [J].
  double energy(double part) const;
  double slope(double part) const { return product(force_, direction_) + part * product(direction_, direction_); }
  /// Scalar product of the pair that a part of the direction makes.
  double curvature(double part) const { return part * part * product(direction_, direction_); }
  void forgetOldest();
  void keep(int i, double part) { pair_[static_cast<std::size_t>(i)] = part * direction_; }

 private:
  using Forces = Eigen::VectorXd;  // kYieldDofs, then one per row
  void setForces(const ConstraintSchur& schur, Forces& forces) const;
  double product(const Forces& a, const Forces& b) const;
  void addMotion(double sign, const Forces& forces, Eigen::VectorXd& values) const;

  const ConstraintRows* rows_ = nullptr;
  Eigen::VectorXd compliance_;  // of each row by itself
  Forces force_, direction_;
  Forces left_, taken_;  // of the gradient, in the first loop
  Forces last_;          // of the last elimination
  std::array<Forces, kHistory> pair_;
};

}  // namespace vibe
