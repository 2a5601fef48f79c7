#include "solver/row_unknowns.hpp"

#include <algorithm>

#include "solver/constraint_schur.hpp"

namespace vibe {

void RowUnknowns::begin(const ConstraintRows& rows) {
  rows_ = &rows;
  const int count = rows.count();
  compliance_.setZero(count);
  int row = 0;
  for (const EquationRow& equation : rows.equations) compliance_[row++] = equation.compliance;
  for (const ContactRows& contact : rows.contacts) {
    compliance_[row] = contact.counts ? contact.compliance : 0;
    row += 3;
  }
  for (const ThreadRows& thread : rows.threads)
    for (int k = 0; k < thread.count(); ++k) compliance_[thread.pullRow(k)] = thread.segments[k].compliance;
  for (Forces* forces : {&force_, &direction_, &left_, &taken_, &last_}) forces->setZero(kYieldDofs + count);
  for (Forces& pair : pair_) pair.setZero(kYieldDofs + count);
}

double RowUnknowns::product(const Forces& a, const Forces& b) const {
  double sum = rows_->tool_yields ? a.head<kYieldDofs>().dot(rows_->tool_compliance * b.head<kYieldDofs>()) : 0;
  for (Eigen::Index row = 0; row < compliance_.size(); ++row)
    sum += compliance_[row] * a[kYieldDofs + row] * b[kYieldDofs + row];
  return sum;
}

// How far rows that forces push give way the other way.
void RowUnknowns::addMotion(double sign, const Forces& forces, Eigen::VectorXd& values) const {
  for (Eigen::Index row = 0; row < compliance_.size(); ++row)
    values[row] += sign * compliance_[row] * forces[kYieldDofs + row];
  if (!rows_->tool_yields) return;
  const YieldVector motion = sign * (rows_->tool_compliance * forces.head<kYieldDofs>());
  rows_->forEachYield([&](int row, const YieldVector& yield) { values[row] += yield.dot(motion); });
}

void RowUnknowns::setForces(const ConstraintSchur& schur, Forces& forces) const {
  forces.head<kYieldDofs>() = schur.pull();
  forces.tail(compliance_.size()) = schur.forces().head(compliance_.size());
}

void RowUnknowns::beginDirection(const ConstraintSchur& schur) {
  setForces(schur, last_);
  left_ = force_ - last_;
  taken_.setZero();
}

void RowUnknowns::subtract(int i, double part) {
  left_ -= part * pair_[static_cast<std::size_t>(i)];
  taken_ += part * pair_[static_cast<std::size_t>(i)];
}

void RowUnknowns::setDirection(const ConstraintSchur& schur, Eigen::VectorXd& moves) {
  setForces(schur, last_);
  direction_ = last_ + taken_ - force_;
  moves = schur.moves();
  addMotion(1, direction_, moves);
}

void RowUnknowns::push(const ConstraintSchur& schur) {
  setForces(schur, last_);
  force_ += last_;
}

double RowUnknowns::energy(double part) const {
  return 0.5 * product(force_, force_) + part * product(force_, direction_) + 0.5 * curvature(part);
}

void RowUnknowns::forgetOldest() {
  std::rotate(pair_.begin(), pair_.begin() + 1, pair_.end());
}

}  // namespace vibe
