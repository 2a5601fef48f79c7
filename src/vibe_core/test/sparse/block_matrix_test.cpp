#include "vibe_core/sparse/block_matrix.hpp"

#include <gtest/gtest.h>

#include <random>

#include "vibe_core/program/error.hpp"

namespace vibe::block_matrix_test {
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

TEST_F(BlockMatrixTest, PlacesOfGroupsAreWhereBlocksAreAddedByNode) {
  const std::vector<int> elements = {3, 0, 1, 4, 1, -1};
  BlockMatrix other = matrix;
  const std::vector<int> places = matrix.placesOf(elements, 3);
  ASSERT_EQ(places.size(), 12u);
  std::size_t at = 0;
  for (std::size_t first = 0; first < elements.size(); first += 3)
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b <= a; ++b, ++at) {
        const int row = elements[first + a], column = elements[first + b];
        EXPECT_EQ(places[at] == BlockMatrix::kNowhere, row < 0 || column < 0);
        if (places[at] == BlockMatrix::kNowhere) continue;
        const Eigen::Matrix3d added =
            static_cast<double>(at + 1) * (row == column ? Eigen::Matrix3d(block + block.transpose()) : block);
        matrix.addAt(places[at], added);
        other.add(row, column, added);
      }
  EXPECT_EQ(dense(matrix), dense(other));
  EXPECT_GT(dense(matrix).norm(), 1);
  EXPECT_EQ(matrix.placesOf(elements, 3), places) << "known already";
  const std::vector<int> missing = {0, 4};
  EXPECT_THROW(matrix.placesOf(missing, 2), Error);
}

TEST_F(BlockMatrixTest, CoupledPairsAreBlocksBesideThePattern) {
  EXPECT_THROW(matrix.add(4, 0, block), Error);
  matrix.couple({{2, 0}, {4, 0}});
  matrix.add(4, 0, block);
  matrix.add(0, 2, block);
  matrix.add(2, 2, Eigen::Matrix3d::Identity());
  EXPECT_EQ(matrix.coupled()[0], block.transpose());
  EXPECT_EQ(matrix.coupled()[1], block);
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(15, -1, 3);
  Eigen::VectorXd out(15);
  matrix.multiply(x.data(), out.data());
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(15);
  expected.segment<3>(0) = block.transpose() * x.segment<3>(12) + block * x.segment<3>(6);
  expected.segment<3>(6) = x.segment<3>(6) + block.transpose() * x.segment<3>(0);
  expected.segment<3>(12) = block * x.segment<3>(0);
  EXPECT_LT((out - expected).norm(), 1e-12);
  matrix.fix(4);
  EXPECT_EQ(matrix.coupled()[1], Eigen::Matrix3d::Zero());
  EXPECT_NE(matrix.coupled()[0], Eigen::Matrix3d::Zero());
}

}  // namespace
}  // namespace vibe::block_matrix_test
