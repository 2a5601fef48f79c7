#include "half_space.hpp"

#include <algorithm>
#include <cmath>

namespace vibe {

namespace {

constexpr int kContactSweeps = 1000;   // opposed contacts, as of a pinch, need hundreds, others few
constexpr double kContactMove = 1e-9;  // sweeps end when none moves its contact farther [m]

// Both sparse vectors consist of whole runs; those on the common part of the paths are the same runs.
Eigen::Matrix3f product(const HalfColumns& a, const HalfColumns& b) {
  Eigen::Matrix3f sum = Eigen::Matrix3f::Zero();
  std::size_t i = 0, j = 0, at_a = 0, at_b = 0;
  while (i < a.begin.size() && j < b.begin.size()) {
    const auto size_a = static_cast<std::size_t>(a.count[i]), size_b = static_cast<std::size_t>(b.count[j]);
    if (a.begin[i] == b.begin[j]) {
      using Rows = Eigen::Map<const Eigen::Matrix<float, 3, Eigen::Dynamic>>;
      sum += Rows(&a.value[3 * at_a], 3, a.count[i]) * Rows(&b.value[3 * at_b], 3, b.count[j]).transpose();
      at_a += size_a, at_b += size_b, ++i, ++j;
    } else if (a.begin[i] < b.begin[j]) {
      at_a += size_a, ++i;
    } else {
      at_b += size_b, ++j;
    }
  }
  return sum;
}

Eigen::Vector3f product(const HalfColumns& a, const float* y) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  const float* value = a.value.data();
  for (std::size_t i = 0; i < a.begin.size(); ++i)
    for (int k = 0; k < a.count[i]; ++k, value += 3) {
      const float factor = y[a.begin[i] + k];
      sum += factor * Eigen::Vector3f(value[0], value[1], value[2]);
    }
  return sum;
}

}  // namespace

void HalfSpace::reset(const Factor& factor, int node_count) {
  slot_of_node_.assign(static_cast<std::size_t>(node_count), -1);
  node_of_slot_.clear();
  columns_.resize(kMostSlots);
  gram_.resize(kMostSlots * (kMostSlots + 1) / 2);
  gram_known_.assign(gram_.size(), 0);
  gas_.assign(static_cast<std::size_t>(factor.rows()) + 16, 0.0F);
  gas_stiffness_ = 0;
  row_count_ = 0;
  findUsedSlots();
}

int HalfSpace::slotOf(int node, const Factor& factor) {
  int& slot = slot_of_node_[node];
  if (slot < 0) {
    slot = static_cast<int>(node_of_slot_.size());
    node_of_slot_.push_back(node);
    if (node_of_slot_.size() > columns_.size()) {
      columns_.resize(node_of_slot_.size());
      gram_.resize(columns_.size() * (columns_.size() + 1) / 2);
      gram_known_.resize(gram_.size(), 0);
    }
    factor.halfColumns(node, columns_[slot]);
  }
  return slot;
}

const Eigen::Matrix3f& HalfSpace::gram(int a, int b) {
  const std::size_t at = static_cast<std::size_t>(a) * (static_cast<std::size_t>(a) + 1) / 2 + b;
  if (gram_known_[at] == 0) {
    gram_[at] = product(columns_[a], columns_[b]);
    gram_known_[at] = 1;
  }
  return gram_[at];
}

void HalfSpace::setRows(const std::vector<HalfRow>& rows, const Factor& factor) {
  // the columns that this step does not need go when there are too many
  std::size_t wanted = 0;
  for (const HalfRow& row : rows) wanted += row.node.size();
  if (node_of_slot_.size() + wanted > kMostSlots) {
    for (int node : node_of_slot_) slot_of_node_[node] = -1;
    node_of_slot_.clear();
    std::fill(gram_known_.begin(), gram_known_.end(), char{0});
  }
  row_count_ = static_cast<int>(rows.size());
  if (rows_.size() < rows.size()) {  // they never become fewer, and keep their memory
    rows_.resize(rows.size());
    row_slots_.resize(rows.size());
  }
  std::copy(rows.begin(), rows.end(), rows_.begin());
  equations_.clear(), contacts_.clear();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    row_slots_[i].clear();
    for (int node : rows[i].node) row_slots_[i].push_back(slotOf(node, factor));
    if (rows[i].friction < 0) {
      equations_.push_back(static_cast<int>(i));
    } else {
      for (int k = 0; k < 3; ++k) contacts_.push_back(static_cast<int>(i) + k);
      for (int k = 1; k < 3; ++k) {
        row_slots_[i + k].clear();
        for (int node : rows[i + k].node) row_slots_[i + k].push_back(slotOf(node, factor));
      }
      i += 2;
    }
  }
  findUsedSlots();
  formCompliance();
}

void HalfSpace::findUsedSlots() {
  used_slots_.clear();
  for (int i = 0; i < row_count_; ++i)
    used_slots_.insert(used_slots_.end(), row_slots_[i].begin(), row_slots_[i].end());
  // by node: the slots' numbers depend on what was touched before, and sums must not
  std::sort(used_slots_.begin(), used_slots_.end(), [&](int a, int b) { return node_of_slot_[a] < node_of_slot_[b]; });
  used_slots_.erase(std::unique(used_slots_.begin(), used_slots_.end()), used_slots_.end());
  seen_.resize(columns_.size());
  row_value_.setZero(rowCount());
}

void HalfSpace::setGas(const float* direction4, double stiffness, const Factor& factor) {
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
void HalfSpace::findRowValues(const float* y) {
  for (const int slot : used_slots_) seen_[slot] = product(columns_[slot], y);
  for (int i = 0; i < rowCount(); ++i) {
    row_value_[i] = 0;
    for (std::size_t k = 0; k < row_slots_[i].size(); ++k)
      row_value_[i] += rows_[i].coefficient[k].dot(seen_[row_slots_[i][k]].cast<double>());
  }
}

void HalfSpace::addForces(float* y) {
  for (const int slot : used_slots_) seen_[slot].setZero();
  for (int i = 0; i < rowCount(); ++i)
    for (std::size_t k = 0; k < row_slots_[i].size(); ++k)
      seen_[row_slots_[i][k]] += (force_[i] * rows_[i].coefficient[k]).cast<float>();
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

void HalfSpace::formCompliance() {
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
  formBlocks();
}

double HalfSpace::complianceBetween(int i, int j) {
  double sum = 0;
  for (std::size_t a = 0; a < row_slots_[i].size(); ++a)
    for (std::size_t b = 0; b < row_slots_[j].size(); ++b) {
      const int sa = row_slots_[i][a], sb = row_slots_[j][b];
      const Eigen::Matrix3d g = (sa >= sb ? gram(sa, sb) : Eigen::Matrix3f(gram(sb, sa).transpose())).cast<double>();
      sum += rows_[i].coefficient[a].dot(g * rows_[j].coefficient[b]);
    }
  return sum;
}

// The equations are eliminated from the contacts. Loops, since indexed views of Eigen ask for memory.
void HalfSpace::formBlocks() {
  const auto e = static_cast<Eigen::Index>(equations_.size()), c = static_cast<Eigen::Index>(contacts_.size());
  if (e > 0) {
    block_.resize(e, e);
    for (Eigen::Index j = 0; j < e; ++j)
      for (Eigen::Index i = 0; i < e; ++i) block_(i, j) = compliance_(equations_[i], equations_[j]);
    equation_factor_.compute(block_);
  }
  if (c == 0) return;
  schur_.resize(c, c);
  for (Eigen::Index j = 0; j < c; ++j)
    for (Eigen::Index i = 0; i < c; ++i) schur_(i, j) = compliance_(contacts_[i], contacts_[j]);
  if (e == 0) return;
  cross_.resize(e, c);
  coupling_.resize(e, c);
  for (Eigen::Index j = 0; j < c; ++j) {
    for (Eigen::Index i = 0; i < e; ++i) cross_(i, j) = compliance_(equations_[i], contacts_[j]);
    coupling_.col(j) = equation_factor_.solve(cross_.col(j));
  }
  schur_.noalias() -= cross_.transpose().lazyProduct(coupling_);
}

// Projected Gauss-Seidel on the contacts with the equations eliminated, to their forces from what each row lacks.
void HalfSpace::solveContacts() {
  const auto n = static_cast<int>(contacts_.size());
  Eigen::VectorXd& lambda = contact_force_;
  lambda.setZero(n);
  double moved = 2 * kContactMove;
  for (int sweep = 0; sweep < kContactSweeps && moved > kContactMove; ++sweep) {
    moved = 0;
    for (int i = 0; i < n; i += 3) {
      const Eigen::Vector3d before = lambda.segment<3>(i);
      const double normal_lack = contact_lack_[i] - schur_.row(i).dot(lambda);
      lambda[i] = std::max(0.0, lambda[i] + normal_lack / schur_(i, i));
      const double limit = rows_[contacts_[i]].friction * lambda[i];
      for (int k = 1; k < 3; ++k)
        lambda[i + k] += (contact_lack_[i + k] - schur_.row(i + k).dot(lambda)) / schur_(i + k, i + k);
      const double size = std::hypot(lambda[i + 1], lambda[i + 2]);
      if (size > limit) {
        lambda[i + 1] *= limit / size;
        lambda[i + 2] *= limit / size;
      }
      for (int k = 0; k < 3; ++k) moved = std::max(moved, std::abs(lambda[i + k] - before[k]) * schur_(i + k, i + k));
    }
  }
  for (int i = 0; i < n; ++i) force_[contacts_[i]] = lambda[i];
}

// The rows' forces from what each of them lacks.
void HalfSpace::solveRows() {
  const auto e = static_cast<Eigen::Index>(equations_.size()), c = static_cast<Eigen::Index>(contacts_.size());
  force_.setZero(rowCount());
  equation_lack_.resize(e);
  for (Eigen::Index i = 0; i < e; ++i) equation_lack_[i] = lack_[equations_[i]];
  if (c > 0) {
    contact_lack_.resize(c);
    for (Eigen::Index i = 0; i < c; ++i) contact_lack_[i] = lack_[contacts_[i]];
    if (e > 0) contact_lack_.noalias() -= coupling_.transpose() * equation_lack_;
    solveContacts();
    if (e > 0) equation_lack_.noalias() -= cross_ * contact_force_;
  }
  if (e > 0) solveEquations();
}

void HalfSpace::solveEquations() {
  equation_force_ = equation_factor_.solve(equation_lack_);
  for (std::size_t i = 0; i < equations_.size(); ++i)
    force_[equations_[i]] = equation_force_[static_cast<Eigen::Index>(i)];
}

void HalfSpace::eliminate(const Eigen::Ref<const Eigen::VectorXd>& wanted, double swelling, float* y) {
  const int m = rowCount();
  double gas_lack = 0;
  if (gas_stiffness_ != 0) {
    double along = 0;
    for (std::size_t i = 0; i < gas_.size(); ++i) along += static_cast<double>(gas_[i]) * y[i];
    gas_lack = swelling - along;
  }
  findRowValues(y);
  lack_ = wanted - row_value_;
  if (gas_stiffness_ != 0 && m > 0) lack_ -= gas_row_ * (gas_lack / gas_norm2_);
  solveRows();
  addForces(y);
  gas_force_ = 0;
  if (gas_stiffness_ != 0) {
    gas_force_ = (gas_lack - (m > 0 ? gas_row_.dot(force_) : 0.0)) / gas_norm2_;
    const auto f = static_cast<float>(gas_force_);
    for (std::size_t i = 0; i < gas_.size(); ++i) y[i] += f * gas_[i];
  }
}

}  // namespace vibe
