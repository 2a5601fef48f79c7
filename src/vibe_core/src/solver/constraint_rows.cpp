#include "solver/constraint_rows.hpp"

#include <algorithm>

#include "arithmetic/ordered_algebra.hpp"
#include "solver/constraint_schur.hpp"

namespace vibe {

void LinearForm::setPoint(const SurfacePoint& point, const Eigen::Vector3d& direction) {
  node.assign(point.node.begin(), point.node.begin() + point.count);
  coefficient.clear();
  for (int k = 0; k < point.count; ++k) coefficient.emplace_back(point.weight[static_cast<std::size_t>(k)] * direction);
}

void LinearForm::setPoint(const AttachmentPoint& point, const Eigen::Vector3d& direction) {
  node.assign(point.node.begin(), point.node.end());
  coefficient.clear();
  for (const double weight : point.weight) coefficient.emplace_back(weight * direction);
}

double LinearForm::value(const std::vector<double>& position4) const {
  double sum = 0;
  for (std::size_t k = 0; k < node.size(); ++k) {
    const double* p = &position4[4 * static_cast<std::size_t>(node[k])];
    sum += coefficient[k].dot(Eigen::Vector3d(p[0], p[1], p[2]));
  }
  return sum;
}

void LinearForm::addForce(double force, std::vector<float>& vector4) const {
  for (std::size_t i = 0; i < node.size(); ++i)
    for (int k = 0; k < 3; ++k)
      vector4[4 * static_cast<std::size_t>(node[i]) + k] += static_cast<float>(force * coefficient[i][k]);
}

void ConstraintRows::clear() {
  equations.clear();
  contacts.clear();
  counted = 0;
  threads.clear();
  tool_compliance.setZero();
  tool_yields = false;
}

void ConstraintRows::number(std::size_t contacts_that_count) {
  counted = contacts_that_count;
  int row = contactRow(counted);
  for (ThreadRows& thread : threads) {
    thread.first_row = row;
    row += 3 * thread.count();
  }
}

int ConstraintRows::count() const {
  int sum = contactRow(counted);
  for (const ThreadRows& thread : threads) sum += 3 * thread.count();
  return sum;
}

void RowUnknowns::begin(const ConstraintRows& rows) {
  rows_ = &rows;
  const int count = rows.count();
  compliance_.setZero(count);
  int row = 0;
  for (const EquationRow& equation : rows.equations) compliance_[row++] = equation.compliance;
  for (std::size_t c = 0; c < rows.counted; ++c, row += 3) compliance_[row] = rows.contacts[c].compliance;
  for (const ThreadRows& thread : rows.threads)
    for (int k = 0; k < thread.count(); ++k) compliance_[thread.pullRow(k)] = thread.segments[k].compliance;
  for (Forces* forces : {&force_, &direction_, &left_, &taken_, &last_}) forces->setZero(kYieldDofs + count);
  for (Forces& pair : pair_) pair.setZero(kYieldDofs + count);
  for (Eigen::VectorXd* lost : {&lost_, &loss_}) lost->setZero(count);
  for (Eigen::VectorXd& pair : pair_loss_) pair.setZero(count);
}

double RowUnknowns::product(const Forces& a, const Forces& b) const {
  double sum =
      rows_->tool_yields ? fixedDot(a.head<kYieldDofs>(), (rows_->tool_compliance * b.head<kYieldDofs>()).eval()) : 0;
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
  rows_->forEachYield([&](int row, const YieldVector& yield) { values[row] += fixedDot(yield, motion); });
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
  loss_ = schur.lost() - lost_;
  moves = schur.moves();
  addMotion(1, direction_, moves);
}

void RowUnknowns::reduce(int i, double part, Eigen::VectorXd& moves) {
  const auto pair = static_cast<std::size_t>(i);
  direction_ -= part * pair_[pair];
  loss_ -= part * pair_loss_[pair];
  moves -= part * pair_loss_[pair];
}

void RowUnknowns::move(double part) {
  force_ += part * direction_;
  lost_ += part * loss_;
}

void RowUnknowns::keep(int i, double part) {
  pair_[static_cast<std::size_t>(i)] = part * direction_;
  pair_loss_[static_cast<std::size_t>(i)] = part * loss_;
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
  std::rotate(pair_loss_.begin(), pair_loss_.begin() + 1, pair_loss_.end());
}

}  // namespace vibe
