#include "solver/constraint_schur.hpp"

#include <algorithm>
#include <cmath>

namespace vibe {

namespace {

// Sweeps over threads and contacts in turn. Design choice: threads affect each other little; what a sweep more would
// change slides in the next iteration.
constexpr int kSlideSweeps = 30;
// They end when no force moves its row farther than this. Design choice: a hundredth of what can be seen [m].
constexpr double kSlideMove = 1e-7;

}  // namespace

void ConstraintSchur::reset(const Factor& factor) {
  gas_.assign(static_cast<std::size_t>(factor.rows()) + 16, 0.0F);
  gas_stiffness_ = 0;
  rows_.clear();
  cache_ = nullptr;
  row_value_.resize(0);
  formed_ = rows_formed_ = false;
}

void ConstraintSchur::setGas(const float* direction4, double stiffness, const Factor& factor) {
  const bool had_gas = gas_stiffness_ != 0;
  gas_stiffness_ = stiffness;
  if (stiffness == 0) {
    formed_ = formed_ && !had_gas;
    return;
  }
  factor.load(direction4, gas_.data());
  factor.forward(gas_.data(), *pool_);
  double norm2 = 0;
  for (int i = 0; i < factor.rows(); ++i) norm2 += static_cast<double>(gas_[i]) * gas_[i];
  gas_norm2_ = norm2 + (std::isinf(stiffness) ? 0 : 1 / stiffness);
  formed_ = false;
}

void ConstraintSchur::formCompliance() {
  if (formed_) return;
  formed_ = true;
  blocks_formed_ = false;
  const int m = rowCount();
  if (!rows_formed_) rows_.compliances(row_compliance_);
  rows_formed_ = true;
  compliance_ = row_compliance_;
  force_.setZero(m);
  gas_row_.setZero(m);
  if (gas_stiffness_ != 0 && m > 0) {
    multiplyRows(gas_.data(), false);
    rows_.values(gas_row_);
    for (int j = 0; j < m; ++j) compliance_.col(j) -= (gas_row_[j] / gas_norm2_) * gas_row_;
  }
  if (yields_) compliance_.noalias() += yield_.transpose().lazyProduct(given_);
}

// The equations are eliminated from the contacts. Loops, since indexed views of Eigen ask for memory.
void ConstraintSchur::formBlocks() {
  if (blocks_formed_) return;
  blocks_formed_ = true;
  const auto e = static_cast<Eigen::Index>(equations_.size());
  const auto c = static_cast<Eigen::Index>(inequalities_.size());
  // equations hold whatever contacts and threads do: they are eliminated first
  if (e > 0) {
    block_.resize(e, e);
    for (Eigen::Index j = 0; j < e; ++j)
      for (Eigen::Index i = 0; i < e; ++i) block_(i, j) = compliance_(equations_[i], equations_[j]);
    equation_factor_.compute(block_);
  }
  contacts_.begin(static_cast<int>(c));
  for (Eigen::Index j = 0; j < c; ++j)
    for (Eigen::Index i = 0; i < c; ++i)
      contacts_.compliance(static_cast<int>(i), static_cast<int>(j)) = compliance_(inequalities_[i], inequalities_[j]);
  if (e > 0) eliminateEquations(e, c);
  // what is left is the compliance between contacts and threads
  for (const Contact& contact : contact_list_) contacts_.addContact(contact.first, contact.friction);
  contacts_.finish();
  thread_slides_.beginCompliance();
  for (int j = 0; j < thread_slides_.size(); ++j)
    for (int i = 0; i < thread_slides_.size(); ++i)
      thread_slides_.compliance(i, j) = contacts_.compliance(first_pull_ + i, first_pull_ + j);
}

void ConstraintSchur::eliminateEquations(Eigen::Index e, Eigen::Index c) {
  cross_.resize(e, c);
  coupling_.resize(e, c);
  for (Eigen::Index j = 0; j < c; ++j) {
    for (Eigen::Index i = 0; i < e; ++i) cross_(i, j) = compliance_(equations_[i], inequalities_[j]);
    coupling_.col(j) = cross_.col(j);
    equation_factor_.solve(coupling_.col(j));
  }
  for (Eigen::Index i = 0; i < c; ++i)
    for (Eigen::Index j = 0; j <= i; ++j) {
      const double taken = orderedDot(cross_.col(i), coupling_.col(j));
      contacts_.compliance(static_cast<int>(i), static_cast<int>(j)) -= taken;
      if (i != j) contacts_.compliance(static_cast<int>(j), static_cast<int>(i)) -= taken;
    }
}

// The forces of contacts and threads with the equations eliminated, from what each row lacks. They begin with those of
// the last elimination.
void ConstraintSchur::solveContacts() {
  slideThreads();
  violation_ = contacts_.solve(contact_residual_.data(), contact_force_.data());
  if (!threads_held_) violation_ = std::max(violation_, thread_slides_.violation());
  for (std::size_t i = 0; i < inequalities_.size(); ++i) {
    const int row = inequalities_[i];
    force_[row] = contact_force_[static_cast<Eigen::Index>(i)];
    moves_[row] -= contacts_.left(static_cast<int>(i));
    holds_[static_cast<std::size_t>(row)] = contacts_.holds(static_cast<int>(i)) ? 1 : 0;
  }
}

// How far threads slide through their eyelets, in turn with what contacts take from them.
void ConstraintSchur::slideThreads() {
  const int count = thread_slides_.size();
  if (count == 0 || threads_held_) return;
  thread_lack_.resize(static_cast<std::size_t>(count));
  double moved = 2 * kSlideMove;
  for (int sweep = 0; sweep < kSlideSweeps && moved > kSlideMove; ++sweep) {
    moved = contact_list_.empty() ? 0 : contacts_.sweepContacts(contact_residual_.data(), contact_force_.data());
    for (int k = 0; k < count; ++k) {
      double& lack = thread_lack_[static_cast<std::size_t>(k)] = contact_residual_[first_pull_ + k];
      for (int j = 0; j < first_pull_; ++j) lack -= contacts_.compliance(first_pull_ + k, j) * contact_force_[j];
    }
    thread_slides_.solve(thread_lack_.data());
    for (int k = 0; k < count; ++k) {
      double& force = contact_force_[first_pull_ + k];
      moved = std::max(moved, std::abs(thread_slides_.tension(k) - force) * thread_slides_.compliance(k, k));
      force = thread_slides_.tension(k);
    }
    if (contact_list_.empty()) break;  // they are alone
  }
  noteSlides();
}

void ConstraintSchur::noteSlides() {
  for (int k = 0; k < thread_slides_.size(); ++k) {
    const double lost = thread_slides_.lost(k);
    lost_[inequalities_[static_cast<std::size_t>(first_pull_ + k)]] = lost;
    moves_[inequalities_[static_cast<std::size_t>(first_pull_ + k)]] += lost;  // its spots have to come nearer
    contact_residual_[first_pull_ + k] += lost;
  }
}

// The rows' forces from what each of them lacks.
void ConstraintSchur::solveRows() {
  const auto e = static_cast<Eigen::Index>(equations_.size()), c = static_cast<Eigen::Index>(inequalities_.size());
  force_.setZero(rowCount());
  violation_ = 0;
  equation_residual_.resize(e);
  for (Eigen::Index i = 0; i < e; ++i) equation_residual_[i] = residual_[equations_[i]];
  if (c > 0) {
    contact_residual_.resize(c);
    for (Eigen::Index i = 0; i < c; ++i) contact_residual_[i] = residual_[inequalities_[i]];
    if (e > 0) addTransposedProduct(coupling_, equation_residual_, -1, contact_residual_);
    solveContacts();
    if (e > 0) addProduct(cross_, contact_force_, -1, equation_residual_);
  }
  if (e > 0) solveEquations();
}

void ConstraintSchur::solveEquations() {
  equation_force_ = equation_residual_;
  equation_factor_.solve(equation_force_);
  for (std::size_t i = 0; i < equations_.size(); ++i)
    force_[equations_[i]] = equation_force_[static_cast<Eigen::Index>(i)];
}

void ConstraintSchur::eliminate(const Eigen::Ref<const Eigen::VectorXd>& rhs, double swelling, float* y) {
  formCompliance();
  formBlocks();
  const int m = rowCount();
  // what the vector does to the gas and to the rows, before their forces
  double gas_residual = 0;
  const double along = multiplyRows(y, gas_stiffness_ != 0);
  if (gas_stiffness_ != 0) gas_residual = swelling - along;
  if (m > 0) rows_.values(row_value_);
  moves_ = rhs;
  lost_.setZero(m);
  holds_.assign(static_cast<std::size_t>(m), 1);
  for (const int row : idle_) holds_[static_cast<std::size_t>(row)] = 0;
  // what the rows lack, the gas taken into account: it takes a part of every force (Woodbury)
  residual_ = rhs - row_value_;
  if (gas_stiffness_ != 0 && m > 0) residual_ -= gas_row_ * (gas_residual / gas_norm2_);
  solveRows();
  // rows give by their compliance, and with a tool that yields
  for (int i = 0; i < m; ++i) moves_[i] -= rows_.compliance(i) * force_[i];
  pull_.setZero();
  if (yields_) {
    for (int i = 0; i < m; ++i) pull_ += force_[i] * yield_.col(i);
    for (int i = 0; i < m; ++i) moves_[i] -= fixedDot(given_.col(i), pull_);
  }
  gas_force_ = 0;
  if (gas_stiffness_ != 0) gas_force_ = (gas_residual - (m > 0 ? orderedDot(gas_row_, force_) : 0.0)) / gas_norm2_;
  addForces(y);
}

// @returns the product of the gas and the vector; 0 without it
double ConstraintSchur::multiplyRows(const float* y, bool with_gas) {
  double along = 0;
  pool_->parallelFor(1 + (rowCount() > 0 ? rows_.pieces() : 0), 1, [&](int k, int) {
    if (k > 0) return rows_.multiply(*cache_, k - 1, y);
    for (std::size_t i = 0; i < gas_.size() && with_gas; ++i) along += static_cast<double>(gas_[i]) * y[i];
  });
  return along;
}

// Of rows and gas.
void ConstraintSchur::addForces(float* y) {
  const int rows = rowCount(), size = static_cast<int>(gas_.size());
  if (rows > 0) rows_.setForces(force_);
  const auto addTo = [&](RowRange range) {
    if (rows > 0) rows_.addForces(*cache_, range, y);
    const auto f = static_cast<float>(gas_force_);
    for (int i = range.first; i < range.last && gas_stiffness_ != 0; ++i) y[i] += f * gas_[i];
  };
  if (pool_->threads() == 1 || rows == 0) return addTo({0, size});
  pool_->parallelFor(HalfRows::kParts, 1, [&](int k, int) { addTo(rows_.part(*cache_, k, size)); });
}

}  // namespace vibe
