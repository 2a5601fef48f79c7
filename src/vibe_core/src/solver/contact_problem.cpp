#include "solver/contact_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "arithmetic/elementary.hpp"
#include "vibe_core/solver/step_policy.hpp"

namespace vibe {

namespace {

double sizeOf(const double* tangent) {
  return std::sqrt(tangent[0] * tangent[0] + tangent[1] * tangent[1]);
}

}  // namespace

void ContactProblem::begin(int rows) {
  n_ = rows;
  const auto n = static_cast<std::size_t>(rows);
  compliance_.resize(n * n);
  left_.assign(n, 0.0);
  best_force_.resize(n);
  step_.resize(n);
  group_of_row_.assign(n, kNone);
  groups_.clear();
  factored_ = false;
  factorizations_ = 0;
}

void ContactProblem::addGroup(int first, int rows, double friction) {
  for (int k = 0; k < rows; ++k) group_of_row_[static_cast<std::size_t>(first + k)] = static_cast<int>(groups_.size());
  Group group;
  group.first = first;
  group.rows = rows;
  group.friction = friction;
  groups_.push_back(group);
}

void ContactProblem::addContact(int first, double friction) {
  addGroup(first, friction > 0 ? 3 : 1, friction);
}

void ContactProblem::finish() {
  contact_count_ = static_cast<int>(groups_.size());
  for (int i = 0; i < n_; ++i) {
    if (group_of_row_[static_cast<std::size_t>(i)] == kNone) addGroup(i, 1, 0);
    compliance(i, i) *= 1 + stepPolicy().shared_softness;
  }
  for (Group& group : groups_) {
    const int i = group.first;
    group.normal_gain = 1 / compliance(i, i);
    if (group.rows == 1) continue;
    const double a = compliance(i + 1, i + 1), b = compliance(i + 2, i + 2), c = compliance(i + 1, i + 2);
    group.tangent_gain = 1 / (0.5 * (a + b) + math::hypot(0.5 * (a - b), c));  // of the softer direction
  }
  mode_.assign(groups_.size(), Mode::Open);
  factored_mode_.assign(groups_.size(), Mode::Open);
  slip_.assign(groups_.size(), Slip());
}

bool ContactProblem::holds(int row) const {
  const auto group = static_cast<std::size_t>(group_of_row_[static_cast<std::size_t>(row)]);
  return mode_[group] == Mode::Sticks || (mode_[group] == Mode::Slips && row == groups_[group].first);
}

void ContactProblem::findLeft(const double* lack, const double* force) {
  std::copy(lack, lack + n_, left_.begin());
  kernels_.subtractRows(left_.data(), n_, compliance_.data(), force, n_);
}

void ContactProblem::change(int row, double by, double* force) {
  if (by == 0) return;
  force[row] += by;
  kernels_.subtractRows(left_.data(), n_, &compliance_[at(row, 0)], &by, 1);
}

// @returns the largest move of a row [m]
double ContactProblem::sweep(double* force, bool contacts_only) {
  double moved = 0;
  for (const Group& group : groups_) {
    if (contacts_only && group_of_row_[static_cast<std::size_t>(group.first)] >= contact_count_) continue;
    const int i = group.first;
    const double normal = std::max(0.0, force[i] + group.normal_gain * left(i)) - force[i];
    change(i, normal, force);
    moved = std::max(moved, std::abs(normal) / group.normal_gain);
    if (group.rows == 1) continue;
    double wanted[2] = {force[i + 1] + group.tangent_gain * left(i + 1),
                        force[i + 2] + group.tangent_gain * left(i + 2)};
    const double limit = group.friction * force[i], size = sizeOf(wanted), part = size > limit ? limit / size : 1;
    for (int k = 0; k < 2; ++k) {
      const double by = part * wanted[k] - force[i + 1 + k];
      change(i + 1 + k, by, force);
      moved = std::max(moved, std::abs(by) / group.tangent_gain);
    }
  }
  return moved;
}

double ContactProblem::sweepContacts(const double* lack, double* force) {
  findLeft(lack, force);
  return sweep(force, true);
}

// Which rows act, from forces and what is left of the lack. Takes the force from those that do not.
// @returns whether forces have changed
bool ContactProblem::classify(double* force) {
  bool changed = false;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const Group& group = groups_[g];
    const int i = group.first;
    const double normal = force[i] + group.normal_gain * left(i);
    mode_[g] = Mode::Sticks;
    // a contact that would pull is open
    if (!(normal > 0)) {
      mode_[g] = Mode::Open;
      for (int k = 0; k < group.rows; ++k) {
        changed = changed || force[i + k] != 0;
        force[i + k] = 0;
      }
      continue;
    }
    if (group.rows == 1) continue;
    // the force that would make it stick, if friction allows it
    const double wanted[2] = {force[i + 1] + group.tangent_gain * left(i + 1),
                              force[i + 2] + group.tangent_gain * left(i + 2)};
    const double size = sizeOf(wanted);
    if (size <= group.friction * normal) continue;
    // it slips along that force; while the contact is light, its direction may turn
    mode_[g] = Mode::Slips;
    Slip& slip = slip_[g];
    for (int k = 0; k < 2; ++k) slip.direction[k] = wanted[k] / size;
    slip.turn = std::min(1.0, group.friction * std::max(0.0, force[i]) / size);
  }
  return changed;
}

double ContactProblem::violation(const double* force) const {
  double max = 0;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const Group& group = groups_[g];
    const int i = group.first;
    if (mode_[g] == Mode::Open) {
      max = std::max(max, left(i));
      continue;
    }
    max = std::max(max, std::abs(left(i)));
    if (group.rows == 1) continue;
    const double limit = group.friction * std::max(0.0, force[i]);
    for (int k = 0; k < 2; ++k)
      max = std::max(max, mode_[g] == Mode::Sticks
                              ? std::abs(left(i + 1 + k))
                              : std::abs(force[i + 1 + k] - limit * slip_[g].direction[k]) / group.tangent_gain);
  }
  return max;
}

void ContactProblem::setNormalRow(int equation, int row) {
  double* const to = lu_.row(equation);
  const double* const from = &compliance_[at(row, 0)];
  for (std::size_t a = 0; a < active_.size(); ++a) to[a] = from[active_[a]];
}

// The derivative of force - limit * direction, over the gain.
void ContactProblem::setSlipRows(int equation, const Group& group, const Slip& slip) {
  const double* const d = slip.direction;
  for (int k = 0; k < 2; ++k) {
    double* const to = lu_.row(equation + 1 + k);
    const double p[2] = {(k == 0 ? 1 : 0) - d[k] * d[0], (k == 1 ? 1 : 0) - d[k] * d[1]};
    const double* const rows[2] = {&compliance_[at(group.first + 1, 0)], &compliance_[at(group.first + 2, 0)]};
    for (std::size_t a = 0; a < active_.size(); ++a)
      to[a] = slip.turn * (p[0] * rows[0][active_[a]] + p[1] * rows[1][active_[a]]);
    to[equation] -= group.friction * d[k] / group.tangent_gain;
    for (int j = 0; j < 2; ++j) to[equation + 1 + j] += ((j == k ? 1 : 0) - slip.turn * p[j]) / group.tangent_gain;
  }
}

bool ContactProblem::factorActive() {
  active_.clear();
  for (std::size_t g = 0; g < groups_.size(); ++g)
    for (int k = 0; k < groups_[g].rows && mode_[g] != Mode::Open; ++k) active_.push_back(groups_[g].first + k);
  lu_.resize(static_cast<int>(active_.size()));
  int equation = 0;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const Group& group = groups_[g];
    if (mode_[g] == Mode::Open) continue;
    setNormalRow(equation, group.first);
    if (mode_[g] == Mode::Slips) setSlipRows(equation, group, slip_[g]);
    if (mode_[g] == Mode::Sticks && group.rows > 1)
      for (int k = 1; k < 3; ++k) setNormalRow(equation + k, group.first + k);
    equation += group.rows;
  }
  factored_mode_ = mode_;
  ++factorizations_;
  return factored_ = lu_.factor();
}

void ContactProblem::newtonStep(double* force) {
  std::size_t equation = 0;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const Group& group = groups_[g];
    if (mode_[g] == Mode::Open) continue;
    step_[equation++] = left(group.first);
    const double limit = group.friction * std::max(0.0, force[group.first]);
    for (int k = 0; k < 2 && group.rows > 1; ++k) {
      const int row = group.first + 1 + k;
      step_[equation++] =
          mode_[g] == Mode::Sticks ? left(row) : (limit * slip_[g].direction[k] - force[row]) / group.tangent_gain;
    }
  }
  lu_.solve(step_.data());
  for (std::size_t a = 0; a < active_.size(); ++a) force[active_[a]] += step_[a];
}

void ContactProblem::remember(double found, const double* force) {
  if (!(found < best_)) return;
  best_ = found;
  std::copy(force, force + n_, best_force_.begin());
}

// @returns the violation of the best forces, which it leaves
double ContactProblem::newton(const double* lack, double* force) {
  double before = std::numeric_limits<double>::infinity();
  int factors = 0;
  for (int step = 0; step < stepPolicy().contact_steps && best_ > stepPolicy().contact_tolerance; ++step) {
    findLeft(lack, force);
    if (classify(force)) findLeft(lack, force);
    const double found = violation(force);
    remember(found, force);
    if (best_ <= stepPolicy().contact_tolerance) break;
    if (!factored_ || mode_ != factored_mode_ || !(found < stepPolicy().kept_contraction * before)) {
      if (factors++ == stepPolicy().factorizations || !factorActive()) break;
    }
    before = found;
    newtonStep(force);
  }
  std::copy(best_force_.begin(), best_force_.begin() + n_, force);
  return best_;
}

double ContactProblem::solve(const double* lack, double* force) {
  if (n_ == 0) return 0;
  best_ = std::numeric_limits<double>::infinity();
  if (!factored_) {
    findLeft(lack, force);
    for (int i = 0; i < stepPolicy().first_sweeps; ++i) sweep(force, false);
  }
  double found = newton(lack, force);
  if (!(found <= stepPolicy().contact_tolerance)) {
    if (!std::isfinite(found)) std::fill(force, force + n_, 0.0);
    findLeft(lack, force);
    for (int i = 0; i < stepPolicy().last_sweeps; ++i) sweep(force, false);
    factored_ = false;
    findLeft(lack, force);
    if (classify(force)) findLeft(lack, force);
    remember(violation(force), force);
    std::copy(best_force_.begin(), best_force_.begin() + n_, force);
  }
  findLeft(lack, force);
  if (classify(force)) findLeft(lack, force);
  return best_;
}

}  // namespace vibe
