#include "arithmetic/ordered_algebra.hpp"

#include <gtest/gtest.h>

#include "arithmetic/symmetric_eigen.hpp"
#include "vibe_core/arithmetic/random.hpp"
#include "vibe_core/files/fnv1a.hpp"

namespace vibe::ordered_algebra_test {
namespace {

/// Coefficients from -1 to 1 that use all digits.
Eigen::MatrixXd anyMatrix(Eigen::Index rows, Eigen::Index columns, std::uint64_t& state) {
  Eigen::MatrixXd a(rows, columns);
  for (Eigen::Index i = 0; i < a.size(); ++i) a.data()[i] = 2 * nextUniform(state) - 1;
  return a;
}

/// Well conditioned; positive definite or not.
Eigen::MatrixXd anySymmetric(Eigen::Index n, bool positive, std::uint64_t& state) {
  Eigen::MatrixXd a = anyMatrix(n, n, state);
  a = (a + a.transpose()).eval();
  for (Eigen::Index i = 0; i < n; ++i) a(i, i) = (positive || i % 2 == 0 ? 3.0 : -3.0) * static_cast<double>(n);
  return a;
}

void add(const Eigen::VectorXd& x, Fnv1a& hash) {
  hash.add(x.data(), static_cast<std::size_t>(x.size()) * sizeof(double));
}

TEST(OrderedAlgebra, LdltSolvesTheSystem) {
  std::uint64_t state = 1;
  for (const Eigen::Index n : {1, 2, 7, 8, 9, 17, 40, 140})
    for (const bool positive : {true, false}) {
      const Eigen::MatrixXd a = anySymmetric(n, positive, state);
      const Eigen::VectorXd x = anyMatrix(n, 1, state);
      Eigen::VectorXd found = a * x;
      OrderedLdlt factor;
      factor.compute(a);
      factor.solve(found);
      EXPECT_LT((found - x).norm(), 1e-12 * x.norm()) << n;
      EXPECT_TRUE(factor.succeeded());
      EXPECT_EQ(factor.isPositive(), positive || n == 1) << n;
    }
}

TEST(OrderedAlgebra, LdltLeavesOutWhatIsZero) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(3, 3);
  a(0, 0) = 2, a(2, 2) = 4;
  OrderedLdlt factor;
  factor.compute(a);
  EXPECT_TRUE(factor.succeeded() && factor.isPositive());
  Eigen::VectorXd b = Eigen::Vector3d(2, 5, 4);
  factor.solve(b);
  EXPECT_EQ(b, Eigen::VectorXd(Eigen::Vector3d(1, 0, 1)));
  a(1, 0) = a(0, 1) = 0, a(0, 0) = a(2, 2) = 0, a(2, 1) = a(1, 2) = 1;
  factor.compute(a);
  EXPECT_FALSE(factor.succeeded());  // pivots on the diagonal alone cannot solve it
}

TEST(OrderedAlgebra, EigenvectorsAreOrthogonalAndGiveTheMatrix) {
  std::uint64_t state = 2;
  for (int k = 0; k < 200; ++k) {
    Eigen::Matrix3d a = anyMatrix(3, 3, state);
    if (k % 3 == 0) a.row(2).setZero();
    const Eigen::Matrix3d s = a * a.transpose();
    const SymmetricEigen3 eigen(s);
    EXPECT_LT((eigen.vectors.transpose() * eigen.vectors - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_LT((eigen.vectors * eigen.values.asDiagonal() * eigen.vectors.transpose() - s).norm(), 1e-14 * s.norm());
    EXPECT_TRUE(eigen.values[0] <= eigen.values[1] && eigen.values[1] <= eigen.values[2]);
  }
}

/// The bits that recordings were made with, those of Eigen 3.4.0: they must not change with compiler, Eigen or
/// processor.
TEST(OrderedAlgebra, BitsAreThoseOfRecordings) {
  std::uint64_t state = 3;
  Fnv1a hash;
  for (Eigen::Index n = 1; n <= 40; ++n) {
    const Eigen::MatrixXd a = anyMatrix(n, n + 3, state);
    const Eigen::VectorXd x = anyMatrix(n + 3, 1, state), y = anyMatrix(n, 1, state);
    Eigen::VectorXd solved = y, product = y, transposed = x;
    OrderedLdlt factor;
    factor.compute(anySymmetric(n, n % 3 != 0, state));
    factor.solve(solved);
    addProduct(a, x, -1, product);
    addTransposedProduct(a, y, 1, transposed);
    const double dot = orderedDot(solved, product);
    const SymmetricEigen3 eigen(anySymmetric(3, true, state));
    add(solved, hash), add(product, hash), add(transposed, hash), add(Eigen::VectorXd::Constant(1, dot), hash);
    add(eigen.values, hash), add(Eigen::Map<const Eigen::VectorXd>(eigen.vectors.data(), 9), hash);
  }
  EXPECT_EQ(hash.result(), 0x8a4182ecfe682628ULL);
}

}  // namespace
}  // namespace vibe::ordered_algebra_test
