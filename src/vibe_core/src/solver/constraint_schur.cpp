#include "solver/constraint_schur.hpp"

#include <algorithm>
#include <cmath>

namespace vibe {

namespace {

// Limit of the Gauss-Seidel sweeps. Measured: contacts that oppose each other, as in a pinch, need hundreds; others
// few.
constexpr int kContactSweeps = 1000;
// Sweeps end when no force moves its contact farther than this. Design choice: a hundredth of the tolerance of a step
// [m].
constexpr double kContactMove = 1e-9;

}  // namespace

void ConstraintSchur::reset(const Factor& factor, int node_count) {
  node_count_ = node_count;
  slot_of_key_.assign(static_cast<std::size_t>(node_count), -1);
  key_of_slot_.clear();
  columns_.resize(kMaxSlots);
  gram_.resize(kMaxSlots * (kMaxSlots + 1) / 2);
  gram_known_.assign(gram_.size(), 0);
  gas_.assign(static_cast<std::size_t>(factor.rows()) + 16, 0.0F);
  gas_stiffness_ = 0;
  row_count_ = 0;
  findUsedSlots();
}

int ConstraintSchur::slotOf(int key, const Factor& factor, const AttachmentColumns* attachments) {
  int& slot = slot_of_key_[key];
  if (slot < 0) {
    slot = static_cast<int>(key_of_slot_.size());
    key_of_slot_.push_back(key);
    if (key_of_slot_.size() > columns_.size()) {
      columns_.resize(key_of_slot_.size());
      gram_.resize(columns_.size() * (columns_.size() + 1) / 2);
      gram_known_.resize(gram_.size(), 0);
    }
    if (key < node_count_) {
      factor.halfColumns(key, columns_[slot]);
    } else {
      columns_[slot] = attachments->columns[static_cast<std::size_t>(key - node_count_)];
    }
  }
  return slot;
}

const Eigen::Matrix3f& ConstraintSchur::gram(int a, int b) {
  const std::size_t at = static_cast<std::size_t>(a) * (static_cast<std::size_t>(a) + 1) / 2 + b;
  if (gram_known_[at] == 0) {
    const int attachment_a = key_of_slot_[a] - node_count_, attachment_b = key_of_slot_[b] - node_count_;
    if (attachment_a >= 0 && attachment_b >= 0) {
      gram_[at] =
          attachment_a >= attachment_b
              ? attachments_->gram[AttachmentColumns::at(attachment_a, attachment_b)]
              : Eigen::Matrix3f(attachments_->gram[AttachmentColumns::at(attachment_b, attachment_a)].transpose());
    } else {
      gram_[at] = product(columns_[a], columns_[b]);
    }
    gram_known_[at] = 1;
  }
  return gram_[at];
}

// The columns that this step does not need go when there are too many.
void ConstraintSchur::makeRoom(const ConstraintRows& rows, std::size_t attachment_count) {
  std::size_t needed = attachment_count + 3 * rows.contacts.size();
  for (const EquationRow& row : rows.equations) needed += row.form.node.size();
  if (key_of_slot_.size() + needed > kMaxSlots) {
    for (int key : key_of_slot_) slot_of_key_[key] = -1;
    key_of_slot_.clear();
    std::fill(gram_known_.begin(), gram_known_.end(), char{0});
  }
  slot_of_key_.resize(static_cast<std::size_t>(node_count_) + attachment_count, -1);
}

void ConstraintSchur::setRow(int row, const LinearForm& form, double compliance, const Factor& factor) {
  SlotRow& to = rows_[row];
  to.compliance = compliance;
  to.slot.clear();
  for (const int node : form.node) to.slot.push_back(slotOf(node, factor, nullptr));
  to.coefficient = form.coefficient;
}

// From an attachment point to the next: the same as a form in their nodes, in fewer columns.
void ConstraintSchur::setRow(int row, int attachment, const Eigen::Vector3d& along, double compliance,
                             const Factor& factor, const AttachmentColumns* attachments) {
  SlotRow& to = rows_[row];
  to.compliance = compliance;
  to.slot.clear();
  for (const int a : {attachment, attachment + 1}) to.slot.push_back(slotOf(node_count_ + a, factor, attachments));
  to.coefficient.assign({along, -along});
}

void ConstraintSchur::setThreadRows(const ThreadRows& thread, const Factor& factor,
                                    const AttachmentColumns* attachments) {
  for (int k = 0; k < thread.count(); ++k) {
    const SegmentRows& segment = thread.segments[k];
    setRow(thread.pullRow(k), thread.first_attachment + k, segment.along, segment.compliance, factor, attachments);
    for (int j = 0; j < 2; ++j)
      setRow(thread.turnRow(k, j), thread.first_attachment + k, segment.across[j], segment.turn_compliance, factor,
             attachments);
  }
}

void ConstraintSchur::setRows(const ConstraintRows& rows, const Factor& factor, const AttachmentColumns* attachments) {
  makeRoom(rows, attachments == nullptr ? 0 : attachments->attachments.size());
  attachments_ = attachments;
  row_count_ = rows.count();
  const auto count = static_cast<std::size_t>(row_count_);
  if (rows_.size() < count) rows_.resize(count);  // they never become fewer, and keep their memory
  int row = 0;
  for (const EquationRow& equation : rows.equations) setRow(row++, equation.form, equation.compliance, factor);
  for (const ContactRows& contact : rows.contacts)
    for (int k = 0; k < 3; ++k)
      setRow(row++, contact.form[static_cast<std::size_t>(k)], k == 0 ? contact.compliance : 0, factor);
  for (const ThreadRows& thread : rows.threads) setThreadRows(thread, factor, attachments);
  sortRows(rows);
  setYield(rows);
  findUsedSlots();
  formCompliance();
}

void ConstraintSchur::sortRows(const ConstraintRows& rows) {
  equations_.clear(), inequalities_.clear(), contacts_.clear();
  thread_count_ = 0;
  for (int i = 0; i < static_cast<int>(rows.equations.size()); ++i) equations_.push_back(i);
  rows.forEachSpring([this](int row, const LinearForm&, double) { equations_.push_back(row); });
  for (std::size_t c = 0; c < rows.contacts.size(); ++c) {
    contacts_.push_back({static_cast<int>(inequalities_.size()), rows.contacts[c].friction});
    for (int k = 0; k < 3; ++k) inequalities_.push_back(rows.contactRow(c) + k);
  }
  for (const ThreadRows& thread : rows.threads)
    if (thread.count() > 0) addThread(thread);
}

void ConstraintSchur::setYield(const ConstraintRows& rows) {
  yields_ = rows.tool_yields;
  if (!yields_) return;
  yield_.setZero(kYieldDofs, row_count_);
  rows.forEachYield([this](int row, const YieldVector& yield) { yield_.col(row) = yield; });
  tool_compliance_ = rows.tool_compliance;
  given_.resize(kYieldDofs, row_count_);
  for (int i = 0; i < row_count_; ++i) given_.col(i) = tool_compliance_ * yield_.col(i);
}

void ConstraintSchur::addThread(const ThreadRows& rows) {
  if (threads_.size() == static_cast<std::size_t>(thread_count_)) threads_.emplace_back();
  Thread& thread = threads_[thread_count_++];
  thread.first = static_cast<int>(inequalities_.size());
  thread.count = rows.count();
  for (int k = 0; k < thread.count; ++k) inequalities_.push_back(rows.pullRow(k));
  thread.capstan.resize(thread.count - 1);
  for (int k = 0; k + 1 < thread.count; ++k) thread.capstan[k] = rows.segments[k].capstan;
  thread.slide.tension.setZero(thread.count);
  thread.slide.slide.setZero(thread.count - 1);
}

void ConstraintSchur::holdThreads() {
  for (int t = 0; t < thread_count_; ++t) threads_[t].capstan.setConstant(kHoldingFactor);
}

void ConstraintSchur::findUsedSlots() {
  used_slots_.clear();
  for (int i = 0; i < row_count_; ++i)
    used_slots_.insert(used_slots_.end(), rows_[i].slot.begin(), rows_[i].slot.end());
  // by node: the slots' numbers depend on what was touched before, and sums must not
  std::sort(used_slots_.begin(), used_slots_.end(), [&](int a, int b) { return key_of_slot_[a] < key_of_slot_[b]; });
  used_slots_.erase(std::unique(used_slots_.begin(), used_slots_.end()), used_slots_.end());
  seen_.resize(columns_.size());
  row_value_.setZero(rowCount());
}

void ConstraintSchur::setGas(const float* direction4, double stiffness, const Factor& factor) {
  const bool had_gas = gas_stiffness_ != 0;
  gas_stiffness_ = stiffness;
  if (stiffness == 0) {
    if (had_gas) formCompliance();  // without it
    return;
  }
  factor.load(direction4, gas_.data());
  factor.forward(gas_.data());
  double norm2 = 0;
  for (int i = 0; i < factor.rows(); ++i) norm2 += static_cast<double>(gas_[i]) * gas_[i];
  gas_norm2_ = norm2 + (std::isinf(stiffness) ? 0 : 1 / stiffness);
  formCompliance();
}

// What the rows' nodes see of a half-solved vector; each node once, although three rows may share it.
void ConstraintSchur::findRowValues(const float* y) {
  for (const int slot : used_slots_) seen_[slot] = product(columns_[slot], y);
  for (int i = 0; i < rowCount(); ++i) {
    row_value_[i] = 0;
    for (std::size_t k = 0; k < rows_[i].slot.size(); ++k)
      row_value_[i] += rows_[i].coefficient[k].dot(seen_[rows_[i].slot[k]].cast<double>());
  }
}

void ConstraintSchur::addForces(float* y) {
  for (const int slot : used_slots_) seen_[slot].setZero();
  for (int i = 0; i < rowCount(); ++i)
    for (std::size_t k = 0; k < rows_[i].slot.size(); ++k)
      seen_[rows_[i].slot[k]] += (force_[i] * rows_[i].coefficient[k]).cast<float>();
  for (const int slot : used_slots_) {
    if (seen_[slot].isZero(0)) continue;
    const HalfColumns& column = columns_[slot];
    const Eigen::Vector3f c = seen_[slot];
    const float* value = column.value.data();
    for (std::size_t i = 0; i < column.begin.size(); ++i)
      for (int r = 0; r < column.count[i]; ++r, value += 3)
        y[column.begin[i] + r] += value[0] * c[0] + value[1] * c[1] + value[2] * c[2];
  }
}

void ConstraintSchur::formCompliance() {
  const int m = rowCount();
  compliance_.resize(m, m);
  force_.setZero(m);
  for (int i = 0; i < m; ++i)
    for (int j = 0; j <= i; ++j) compliance_(i, j) = compliance_(j, i) = complianceBetween(i, j);
  gas_row_.setZero(m);
  if (gas_stiffness_ != 0 && m > 0) {
    findRowValues(gas_.data());
    gas_row_ = row_value_;
    for (int j = 0; j < m; ++j) compliance_.col(j) -= (gas_row_[j] / gas_norm2_) * gas_row_;
  }
  for (int i = 0; i < m; ++i) compliance_(i, i) += rows_[i].compliance;
  if (yields_) compliance_.noalias() += yield_.transpose().lazyProduct(given_);
  formBlocks();
}

double ConstraintSchur::complianceBetween(int i, int j) {
  double sum = 0;
  for (std::size_t a = 0; a < rows_[i].slot.size(); ++a)
    for (std::size_t b = 0; b < rows_[j].slot.size(); ++b) {
      const int sa = rows_[i].slot[a], sb = rows_[j].slot[b];
      const Eigen::Matrix3d g = (sa >= sb ? gram(sa, sb) : Eigen::Matrix3f(gram(sb, sa).transpose())).cast<double>();
      sum += rows_[i].coefficient[a].dot(g * rows_[j].coefficient[b]);
    }
  return sum;
}

// The equations are eliminated from the contacts. Loops, since indexed views of Eigen ask for memory.
void ConstraintSchur::formBlocks() {
  const auto e = static_cast<Eigen::Index>(equations_.size()), c = static_cast<Eigen::Index>(inequalities_.size());
  if (e > 0) {
    block_.resize(e, e);
    for (Eigen::Index j = 0; j < e; ++j)
      for (Eigen::Index i = 0; i < e; ++i) block_(i, j) = compliance_(equations_[i], equations_[j]);
    equation_factor_.compute(block_);
  }
  if (c == 0) return;
  schur_.resize(c, c);
  for (Eigen::Index j = 0; j < c; ++j)
    for (Eigen::Index i = 0; i < c; ++i) schur_(i, j) = compliance_(inequalities_[i], inequalities_[j]);
  if (e == 0) return;
  cross_.resize(e, c);
  coupling_.resize(e, c);
  for (Eigen::Index j = 0; j < c; ++j) {
    for (Eigen::Index i = 0; i < e; ++i) cross_(i, j) = compliance_(equations_[i], inequalities_[j]);
    coupling_.col(j) = equation_factor_.solve(cross_.col(j));
  }
  schur_.noalias() -= cross_.transpose().lazyProduct(coupling_);
}

// Projected Gauss-Seidel on the contacts and the threads with the equations eliminated, to their forces from what each
// row lacks.
void ConstraintSchur::solveContacts() {
  const auto n = static_cast<int>(inequalities_.size());
  contact_force_.setZero(n);
  double moved = 2 * kContactMove;
  for (int sweep = 0; sweep < kContactSweeps && moved > kContactMove; ++sweep) {
    moved = sweepContacts(contact_force_);
    for (int t = 0; t < thread_count_; ++t) moved = std::max(moved, sweepThread(threads_[t], contact_force_));
    if (contacts_.empty() && thread_count_ == 1) break;  // it is alone
  }
  for (int i = 0; i < n; ++i) force_[inequalities_[i]] = contact_force_[i];
  for (int t = 0; t < thread_count_; ++t) {
    const Thread& thread = threads_[t];
    for (int k = 0; k + 1 < thread.count; ++k) {
      const int row = inequalities_[thread.first + k];
      const double slid = thread.slide.slide[k];
      slid_[row] = slid;
      moves_[row] += slid;  // the segment has lost it: its spots have to come nearer
      moves_[row + 1] -= slid;
    }
  }
}

double ConstraintSchur::sweepContacts(Eigen::VectorXd& lambda) {
  double moved = 0;
  for (const Contact& contact : contacts_) {
    const int i = contact.first;
    const Eigen::Vector3d before = lambda.segment<3>(i);
    const double normal_residual = contact_residual_[i] - schur_.row(i).dot(lambda);
    lambda[i] = std::max(0.0, lambda[i] + normal_residual / schur_(i, i));
    const double limit = contact.friction * lambda[i];
    for (int k = 1; k < 3; ++k)
      lambda[i + k] += (contact_residual_[i + k] - schur_.row(i + k).dot(lambda)) / schur_(i + k, i + k);
    const double size = std::hypot(lambda[i + 1], lambda[i + 2]);
    if (size > limit) {
      lambda[i + 1] *= limit / size;
      lambda[i + 2] *= limit / size;
    }
    for (int k = 0; k < 3; ++k) moved = std::max(moved, std::abs(lambda[i + k] - before[k]) * schur_(i + k, i + k));
  }
  return moved;
}

double ConstraintSchur::sweepThread(Thread& thread, Eigen::VectorXd& lambda) {
  thread_residual_.resize(thread.count);
  for (int k = 0; k < thread.count; ++k) {
    const int i = thread.first + k;
    thread_residual_[k] =
        contact_residual_[i] - schur_.row(i).dot(lambda) +
        schur_.row(i).segment(thread.first, thread.count).dot(lambda.segment(thread.first, thread.count));
  }
  slideThread(thread_residual_, schur_.block(thread.first, thread.first, thread.count, thread.count), thread.capstan,
              thread.slide);
  double moved = 0;
  for (int k = 0; k < thread.count; ++k) {
    const int i = thread.first + k;
    moved = std::max(moved, std::abs(thread.slide.tension[k] - lambda[i]) * schur_(i, i));
    lambda[i] = thread.slide.tension[k];
  }
  return moved;
}

// The rows' forces from what each of them lacks.
void ConstraintSchur::solveRows() {
  const auto e = static_cast<Eigen::Index>(equations_.size()), c = static_cast<Eigen::Index>(inequalities_.size());
  force_.setZero(rowCount());
  equation_residual_.resize(e);
  for (Eigen::Index i = 0; i < e; ++i) equation_residual_[i] = residual_[equations_[i]];
  if (c > 0) {
    contact_residual_.resize(c);
    for (Eigen::Index i = 0; i < c; ++i) contact_residual_[i] = residual_[inequalities_[i]];
    if (e > 0) contact_residual_.noalias() -= coupling_.transpose() * equation_residual_;
    solveContacts();
    if (e > 0) equation_residual_.noalias() -= cross_ * contact_force_;
  }
  if (e > 0) solveEquations();
}

void ConstraintSchur::solveEquations() {
  equation_force_ = equation_factor_.solve(equation_residual_);
  for (std::size_t i = 0; i < equations_.size(); ++i)
    force_[equations_[i]] = equation_force_[static_cast<Eigen::Index>(i)];
}

void ConstraintSchur::eliminate(const Eigen::Ref<const Eigen::VectorXd>& rhs, double swelling, float* y) {
  const int m = rowCount();
  double gas_residual = 0;
  if (gas_stiffness_ != 0) {
    double along = 0;
    for (std::size_t i = 0; i < gas_.size(); ++i) along += static_cast<double>(gas_[i]) * y[i];
    gas_residual = swelling - along;
  }
  findRowValues(y);
  moves_ = rhs;
  slid_.setZero(m);
  residual_ = rhs - row_value_;
  if (gas_stiffness_ != 0 && m > 0) residual_ -= gas_row_ * (gas_residual / gas_norm2_);
  solveRows();
  for (int i = 0; i < m; ++i) moves_[i] -= rows_[i].compliance * force_[i];
  if (yields_) {
    YieldVector pull = YieldVector::Zero();
    for (int i = 0; i < m; ++i) pull += force_[i] * yield_.col(i);
    for (int i = 0; i < m; ++i) moves_[i] -= given_.col(i).dot(pull);
  }
  addForces(y);
  gas_force_ = 0;
  if (gas_stiffness_ != 0) {
    gas_force_ = (gas_residual - (m > 0 ? gas_row_.dot(force_) : 0.0)) / gas_norm2_;
    const auto f = static_cast<float>(gas_force_);
    for (std::size_t i = 0; i < gas_.size(); ++i) y[i] += f * gas_[i];
  }
}

}  // namespace vibe
