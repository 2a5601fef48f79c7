#pragma once

#include <vector>

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
  void eliminate(int k);

  int n_ = 0;
  std::vector<double> a_;  // row after row
  std::vector<int> pivot_;
};

}  // namespace vibe
