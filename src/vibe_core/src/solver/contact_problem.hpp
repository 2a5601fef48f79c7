#pragma once

#include <vector>

#include <Eigen/Core>

#include "solver/dense_row_kernel.hpp"

namespace vibe {

/// Dense factorization with partial pivoting of small matrices whose size changes from one to the next. Keeps its
/// memory.
class DenseLu {
 public:
  /// Makes room for n rows and sets them to zero.
  void resize(int n);
  int size() const { return n_; }
  double* row(int i) { return &a_[static_cast<std::size_t>(i) * static_cast<std::size_t>(n_)]; }
  /// Factors the rows in place.
  /// @returns false if the matrix is singular or not finite
  bool factor();
  /// Solves in place.
  void solve(double* b) const;

 private:
  const double* row(int i) const { return &a_[static_cast<std::size_t>(i) * static_cast<std::size_t>(n_)]; }
  static constexpr int kPanel = 4;
  bool factorPanel(int from, int to);
  void update(int from, int to);

  DenseRowKernels kernels_ = denseRowKernels();
  int n_ = 0;
  std::vector<double> a_;  // row after row
  std::vector<int> pivot_;
};

/// Forces of contacts with Coulomb friction and of one-sided rows, from what each row lacks without them:
///   left = lack - C force
///   one-sided row, normal of a contact:  force >= 0, left <= 0, one of them 0
///   tangents of a contact:  |force| <= friction * normal force; left = 0, or the force is as large as it may be and
///                           points along left (it opposes the slip).
/// Semismooth Newton on the projections of Alart and Curnier (Comput Methods Appl Mech Eng 92:353, 1991), with a factor
/// that is kept while the same rows act; the number of factorizations is bounded, and what they leave is reduced by a
/// bounded number of projected Gauss-Seidel sweeps. A little compliance is added to each row, so that contacts may
/// outnumber what their nodes can distinguish. Keeps its memory.
class ContactProblem {
 public:
  /// Forgets all rows.
  /// @param rows  in total; those that no contact takes are one-sided
  void begin(int rows);
  /// Normal and two tangents in the rows first .. first + 2; without friction a normal only.
  void addContact(int first, double friction);
  /// Compliance between rows, to be set after begin() (lower and upper part) [m/N].
  double& compliance(int i, int j) { return compliance_[at(i, j)]; }
  double compliance(int i, int j) const { return compliance_[at(i, j)]; }
  /// The compliance is set.
  void finish();

  int size() const { return n_; }
  /// @param lack   per row [m]
  /// @param force  in: a guess; out: the solution [N]
  /// @returns the largest violation of a condition [m]
  double solve(const double* lack, double* force);
  /// Gauss-Seidel over the contacts only, for a loop with something else. Continues from `force`.
  /// @returns the largest move of a row [m]
  double sweepContacts(const double* lack, double* force);

  /// What the last solution leaves, per row [m].
  double left(int row) const { return left_[static_cast<std::size_t>(row)]; }
  /// The row moves to its target in the last solution: it is not open and does not slip.
  bool holds(int row) const;
  /// Factorizations since begin().
  int factorizations() const { return factorizations_; }

 private:
  enum class Mode : char { Open, Sticks, Slips };
  struct Group {
    int first = 0;
    int rows = 1;  // 3 with friction
    double friction = 0;
    double normal_gain = 0, tangent_gain = 0;  // force per left [N/m]
  };
  struct Slip {
    double direction[2] = {0, 0};  // of the tentative friction
    double turn = 0;               // limit over its size
  };
  std::size_t at(int i, int j) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(n_) + static_cast<std::size_t>(j);
  }
  void addGroup(int first, int rows, double friction);
  void findLeft(const double* lack, const double* force);
  void change(int row, double by, double* force);
  double sweep(double* force, bool contacts_only);
  bool classify(double* force);
  double violation(const double* force) const;
  double newton(const double* lack, double* force);
  void remember(double violation, const double* force);
  bool factorActive();
  void setNormalRow(int equation, int row);
  void setSlipRows(int equation, const Group& group, const Slip& slip);
  void newtonStep(double* force);

  DenseRowKernels kernels_ = denseRowKernels();
  int n_ = 0;
  std::vector<double> compliance_;  // symmetric
  std::vector<Group> groups_;
  static constexpr int kNone = -1;  // no group yet
  std::vector<int> group_of_row_;
  int contact_count_ = 0;                   // of groups_, the first ones
  std::vector<Mode> mode_, factored_mode_;  // per group
  std::vector<Slip> slip_;                  // per group
  std::vector<double> left_, best_force_, step_;
  std::vector<int> active_;  // rows in the factor
  double best_ = 0;
  bool factored_ = false;
  int factorizations_ = 0;
  DenseLu lu_;
};

}  // namespace vibe
