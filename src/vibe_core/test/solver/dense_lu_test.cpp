// Small dense factorizations against Eigen's.
#include "solver/contact_problem.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "vibe_core/arithmetic/machine.hpp"

namespace vibe {

DenseRowKernels denseRowKernelsSse2();
DenseRowKernels denseRowKernelsAvx2();

}  // namespace vibe

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

/// Numbers between -1 and 1, every seventh of them 0.
std::vector<double> draw(int count, std::mt19937& generator) {
  std::uniform_real_distribution<double> number(-1, 1);
  std::vector<double> drawn(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) drawn[static_cast<std::size_t>(i)] = i % 7 == 3 ? 0 : number(generator);
  return drawn;
}

class DenseRowsOf : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (GetParam() == std::string("avx2") && widestInstructionSet() < InstructionSet::Avx2) GTEST_SKIP() << "no AVX2";
  }
  DenseRowKernels kernels_ = GetParam() == std::string("avx2") ? denseRowKernelsAvx2() : denseRowKernelsSse2();
  std::mt19937 generator_{7};
};

TEST_P(DenseRowsOf, SubtractOneAfterTheOther) {
  for (const int columns : {1, 2, 3, 5, 8, 37})
    for (int rows = 0; rows < 12; ++rows) {
      const std::vector<double> matrix = draw(rows * columns, generator_), factor = draw(rows, generator_);
      std::vector<double> out = draw(columns, generator_), expected = out;
      for (int k = 0; k < rows; ++k)
        for (int i = 0; i < columns; ++i)
          expected[static_cast<std::size_t>(i)] -=
              factor[static_cast<std::size_t>(k)] * matrix[static_cast<std::size_t>(k * columns + i)];
      kernels_.subtractRows(out.data(), columns, matrix.data(), factor.data(), rows);
      EXPECT_EQ(out, expected) << rows << " rows of " << columns;
    }
}

TEST_P(DenseRowsOf, EliminateFourInTheSameOrder) {
  for (const int n : {5, 6, 9, 14, 37})
    for (int to = 4; to < n; to += 4) {
      std::vector<double> a = draw(n * n, generator_), expected = a;
      const auto at = [&](int i, int j) -> double& { return expected[static_cast<std::size_t>(i * n + j)]; };
      for (int i = to; i < n; ++i)
        for (int j = to; j < n; ++j)
          at(i, j) -= (at(i, to - 4) * at(to - 4, j) + at(i, to - 3) * at(to - 3, j)) +
                      (at(i, to - 2) * at(to - 2, j) + at(i, to - 1) * at(to - 1, j));
      kernels_.eliminateFour(a.data(), n, to);
      EXPECT_EQ(a, expected) << n << " rows, " << to;
    }
}

INSTANTIATE_TEST_SUITE_P(Sets, DenseRowsOf, testing::Values("sse2", "avx2"));

}  // namespace
}  // namespace vibe::dense_lu_test
