#pragma once

#include <vector>

#include <Eigen/Core>

// Sums over any number of terms, in an order that is written here. Eigen chooses that of its products, dot() and
// factorisations by its version and by the registers it may use, and with it the last bits of a step. Its operations on
// matrices of a fixed size of up to 3 are the same in all versions from 3.3 to 5.0.

namespace vibe {

using VectorView = Eigen::Ref<const Eigen::VectorXd>;
using MatrixView = Eigen::Ref<const Eigen::MatrixXd>;

/// The sum of the products a[i] b[i].
double orderedDot(const VectorView& a, const VectorView& b);

/// The same of columns of a fixed size above 3 or in single precision: Eigen's dot() differs between versions, its
/// sum() of the products does not.
template <class A, class B>
typename A::Scalar fixedDot(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  return a.cwiseProduct(b).sum();
}

/// out += factor A x
void addProduct(const MatrixView& a, const VectorView& x, double factor, Eigen::Ref<Eigen::VectorXd> out);

/// out += factor A^T x
void addTransposedProduct(const MatrixView& a, const VectorView& x, double factor, Eigen::Ref<Eigen::VectorXd> out);

/// P A P^T = L D L^T of a symmetric matrix, with the largest pivot first; asks for memory only for a larger matrix.
class OrderedLdlt {
 public:
  /// @param symmetric  its lower triangle counts
  void compute(const Eigen::MatrixXd& symmetric);

  /// b becomes A^-1 b; zero pivots give zero.
  void solve(Eigen::Ref<Eigen::VectorXd> b) const;

  bool isPositive() const { return positive_; }  ///< no pivot is below 0
  bool succeeded() const { return succeeded_; }  ///< what zero pivots leave out is zero

 private:
  void bringUp(Eigen::Index k, Eigen::Index largest);
  void solveLower(Eigen::Ref<Eigen::VectorXd> b) const;
  void solveUpper(Eigen::Ref<Eigen::VectorXd> b) const;

  Eigen::MatrixXd l_;  // below the diagonal; on it D
  Eigen::VectorXd temporary_;
  std::vector<Eigen::Index> swapped_;  // row k with this one
  bool positive_ = true, succeeded_ = true;
};

}  // namespace vibe
