#include "sparse/block_matrix.hpp"

#include <gtest/gtest.h>

#include <random>

#include "vibe_core/common/error.hpp"

namespace vibe {
namespace {

Eigen::MatrixXd dense(const BlockMatrix& matrix) {
  const BlockPattern& pattern = matrix.pattern();
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(3 * pattern.size, 3 * pattern.size);
  for (int i = 0; i < pattern.size; ++i) {
    full.block<3, 3>(3 * i, 3 * i) = matrix.diagonal()[i];
    for (int k = pattern.start[i]; k < pattern.start[i + 1]; ++k) {
      full.block<3, 3>(3 * i, 3 * pattern.column[k]) = matrix.lower()[k];
      full.block<3, 3>(3 * pattern.column[k], 3 * i) = matrix.lower()[k].transpose();
    }
  }
  return full;
}

TEST(BlockPatternTest, HoldsTheNodesOfEachGroupOnceAndAscending) {
  const std::vector<int> triangles = {4, 0, 2, 2, 0, 4, 3, 2, -1}, edges = {4, 3};
  const BlockPattern pattern = blockPattern(6, {{&triangles, 3}, {&edges, 2}});
  EXPECT_EQ(pattern.start, (std::vector<int>{0, 0, 0, 1, 2, 5, 5}));
  EXPECT_EQ(pattern.column, (std::vector<int>{0, 2, 0, 2, 3}));
  EXPECT_EQ(pattern.find(4, 2), 3);
  EXPECT_EQ(pattern.find(4, 1), -1);
  EXPECT_EQ(pattern.find(5, 0), -1);
}

TEST(BlockPatternTest, RefusesBrokenGroups) {
  const std::vector<int> outside = {0, 3}, odd = {0, 1, 2};
  EXPECT_THROW(blockPattern(3, {{&outside, 2}}), Error);
  EXPECT_THROW(blockPattern(3, {{&odd, 2}}), Error);
}

class BlockMatrixTest : public ::testing::Test {
 protected:
  BlockMatrixTest() : matrix(std::make_shared<BlockPattern>(blockPattern(5, {{&groups, 3}}))) {
    block << 1, 2, 3, 4, 5, 6, 7, 8, 10;
  }
  const std::vector<int> groups = {0, 1, 3, 1, 3, 4};
  BlockMatrix matrix;
  Eigen::Matrix3d block;
};

TEST_F(BlockMatrixTest, AddsTheTransposeAboveTheDiagonal) {
  matrix.add(3, 1, block);
  matrix.add(1, 3, block);
  const Eigen::MatrixXd full = dense(matrix);
  EXPECT_EQ((full.block<3, 3>(9, 3)), block + block.transpose());
  EXPECT_EQ(full, Eigen::MatrixXd(full.transpose()));
  EXPECT_THROW(matrix.add(4, 0, block), Error);
  EXPECT_THROW(matrix.add(0, 2, block), Error);
  matrix.setZero();
  EXPECT_EQ(dense(matrix).norm(), 0);
}

TEST_F(BlockMatrixTest, MultipliesAsTheFullMatrix) {
  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j <= i; ++j)
      if (i == j || matrix.pattern().find(i, j) >= 0) {
        const Eigen::Matrix3d b = Eigen::Matrix3d::NullaryExpr([&] { return normal(generator); });
        matrix.add(i, j, i == j ? Eigen::Matrix3d(b + b.transpose()) : b);
      }
  const Eigen::VectorXd x = Eigen::VectorXd::NullaryExpr(15, [&] { return normal(generator); });
  Eigen::VectorXd out = Eigen::VectorXd::Constant(15, 7);
  matrix.multiply(x.data(), out.data());
  EXPECT_LT((out - dense(matrix) * x).norm(), 1e-13);
  EXPECT_GT(out.norm(), 1);
}

TEST_F(BlockMatrixTest, FixesRowAndColumn) {
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j <= i; ++j)
      if (i == j || matrix.pattern().find(i, j) >= 0)
        matrix.add(i, j, i == j ? 2 * Eigen::Matrix3d::Identity() : block);
  Eigen::MatrixXd expected = dense(matrix);
  expected.middleRows(3, 3).setZero();
  expected.middleCols(3, 3).setZero();
  expected.block<3, 3>(3, 3).setIdentity();
  matrix.fix(1);
  EXPECT_EQ(dense(matrix), expected);
}

}  // namespace
}  // namespace vibe
