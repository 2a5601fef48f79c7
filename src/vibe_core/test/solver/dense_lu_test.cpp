// Small dense factorizations against Eigen's.
#include "solver/contact_problem.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

namespace vibe::dense_lu_test {
namespace {

TEST(DenseLu, SolvesMatricesThatNeedPivots) {
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  const auto draw = [&] { return normal(generator); };
  DenseLu lu;
  for (const int n : {37, 1, 2, 3, 4, 5, 7, 8, 9, 16, 63}) {
    Eigen::MatrixXd a = Eigen::MatrixXd::NullaryExpr(n, n, draw);
    if (n > 1) a(0, 0) = 0;
    const Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(n, draw);
    lu.resize(n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) lu.row(i)[j] = a(i, j);
    ASSERT_TRUE(lu.factor());
    Eigen::VectorXd x = b;
    lu.solve(x.data());
    EXPECT_LT((x - a.partialPivLu().solve(b)).norm(), 1e-9 * x.norm()) << n;
  }
}

TEST(DenseLu, RefusesASingularMatrix) {
  DenseLu lu;
  lu.resize(3);
  for (int i = 0; i < 3; ++i) lu.row(i)[0] = lu.row(i)[1] = 1;
  EXPECT_FALSE(lu.factor());
}

}  // namespace
}  // namespace vibe::dense_lu_test
