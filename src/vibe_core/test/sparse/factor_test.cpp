#include "vibe_core/sparse/factor.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <limits>
#include <random>

#include "sparse/closed_mesh.hpp"
#include "sparse/eigen_matrix.hpp"
#include "sparse/factor_plan.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/threads/thread_pool.hpp"

namespace vibe::factor_test {
namespace {

using test::closedMesh;
using test::eigenMatrix;
using test::shellMatrix;

Eigen::VectorXd randomVector(int rows, std::mt19937& generator) {
  std::normal_distribution<double> normal;
  return Eigen::VectorXd::NullaryExpr(rows, [&] { return normal(generator); });
}

// sums of positive semidefinite 6 x 6 blocks over random pairs of nodes, of very different size from node to node
BlockMatrix randomMatrix(int nodes, int pairs, std::mt19937& generator) {
  std::uniform_int_distribution<int> pick(0, nodes - 1);
  std::vector<int> list;
  while (static_cast<int>(list.size()) < 2 * pairs) {
    const int i = pick(generator), j = pick(generator);
    if (i != j) list.insert(list.end(), {i, j});
  }
  BlockMatrix matrix(std::make_shared<BlockPattern>(blockPattern(nodes, {{&list, 2}})));
  std::uniform_real_distribution<double> exponent(-3, 3);
  for (std::size_t k = 0; k < list.size(); k += 2) {
    Eigen::Matrix<double, 6, 6> b;
    for (int i = 0; i < 6; ++i) b.col(i) = randomVector(6, generator);
    const Eigen::Matrix<double, 6, 6> a = std::pow(10.0, exponent(generator)) * (b * b.transpose());
    matrix.add(list[k], list[k], a.topLeftCorner<3, 3>());
    matrix.add(list[k + 1], list[k + 1], a.bottomRightCorner<3, 3>());
    matrix.add(list[k + 1], list[k], a.bottomLeftCorner<3, 3>());
  }
  for (int i = 0; i < nodes; ++i)
    matrix.add(i, i,
               0.2 * matrix.diagonal()[i].trace() * Eigen::Matrix3d::Identity() + 1e-4 * Eigen::Matrix3d::Identity());
  return matrix;
}

Eigen::VectorXd solveFloat(const Factor& factor, const Eigen::VectorXd& b) {
  const int nodes = static_cast<int>(b.size()) / 3;
  std::vector<float> nodes4(4 * nodes, 99.0F), vector(factor.rows());
  for (int i = 0; i < nodes; ++i)
    for (int a = 0; a < 3; ++a) nodes4[4 * i + a] = static_cast<float>(b[3 * i + a]);
  factor.load(nodes4.data(), vector.data());
  factor.forward(vector.data());
  factor.backward(vector.data());
  factor.store(vector.data(), nodes4.data());
  Eigen::VectorXd x(b.size());
  for (int i = 0; i < nodes; ++i)
    for (int a = 0; a < 3; ++a) x[3 * i + a] = nodes4[4 * i + a];
  return x;
}

// in the norm that the diagonal of the matrix gives, in which all nodes count alike
double relativeError(const BlockMatrix& matrix, const Eigen::VectorXd& x, const Eigen::VectorXd& expected) {
  double error = 0, size = 0;
  for (int i = 0; i < x.size(); ++i) {
    const double weight = matrix.diagonal()[i / 3](i % 3, i % 3);
    error += weight * (x[i] - expected[i]) * (x[i] - expected[i]);
    size += weight * expected[i] * expected[i];
  }
  return std::sqrt(error / size);
}

void expectSolves(const BlockMatrix& matrix, std::mt19937& generator) {
  const auto plan = makeFactorPlan(matrix.pattern());
  const Eigen::VectorXd b = randomVector(3 * matrix.pattern().size, generator);
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> reference(eigenMatrix(matrix));
  ASSERT_EQ(reference.info(), Eigen::Success);
  const Eigen::VectorXd expected = reference.solve(b);

  Factor wide(plan, FactorStorage::Double), single(plan, FactorStorage::Float), half(plan, FactorStorage::Half);
  for (Factor* factor : {&wide, &single, &half}) ASSERT_TRUE(factor->compute(matrix));
  Eigen::VectorXd x(b.size());
  wide.solve(b.data(), x.data());
  EXPECT_LT(relativeError(matrix, x, expected), 1e-12);
  EXPECT_LT(relativeError(matrix, solveFloat(wide, b), expected), 1e-5);
  EXPECT_LT(relativeError(matrix, solveFloat(single, b), expected), 1e-5);
  EXPECT_LT(relativeError(matrix, solveFloat(half, b), expected), 2e-3);
}

TEST(FactorTest, SolvesRandomMatrices) {
  std::mt19937 generator(11);
  for (const int nodes : {2, 3, 7, 20, 61, 150})
    for (const int per_node : {1, 2, 4}) {
      SCOPED_TRACE(std::to_string(nodes) + " nodes, " + std::to_string(per_node) + " pairs each");
      expectSolves(randomMatrix(nodes, nodes * per_node, generator), generator);
    }
}

TEST(FactorTest, SolvesShells) {
  std::mt19937 generator(12);
  for (const int cuts : {1, 2, 5, 12}) {
    SCOPED_TRACE(cuts);
    expectSolves(shellMatrix(closedMesh(cuts), 1.0, 0.1), generator);
  }
}

TEST(FactorTest, SolvesOneNode) {
  const auto pattern = std::make_shared<BlockPattern>(blockPattern(1, {}));
  BlockMatrix matrix(pattern);
  matrix.add(0, 0, (Eigen::Matrix3d() << 4, 1, 0, 1, 3, 1, 0, 1, 5).finished());
  std::mt19937 generator(13);
  expectSolves(matrix, generator);
}

TEST(FactorTest, SolvesNodesThatNothingCouples) {
  std::mt19937 generator(14);
  BlockMatrix lonely(std::make_shared<BlockPattern>(blockPattern(5, {})));
  for (int i = 0; i < 5; ++i) lonely.add(i, i, (i + 1.0) * Eigen::Matrix3d::Identity());
  expectSolves(lonely, generator);

  const std::vector<int> parts = {7, 3, 1, 9, 8, 0};
  BlockMatrix islands(std::make_shared<BlockPattern>(blockPattern(11, {{&parts, 3}})));
  for (int i = 0; i < 11; ++i) islands.add(i, i, 2.0 * Eigen::Matrix3d::Identity());
  islands.add(7, 3, 0.5 * Eigen::Matrix3d::Identity());
  islands.add(9, 0, Eigen::Vector3d(0.1, 0.2, 0.3) * Eigen::RowVector3d(1, 1, 1));
  expectSolves(islands, generator);
}

TEST(FactorTest, LeavesFixedNodesAlone) {
  std::mt19937 generator(15);
  BlockMatrix matrix = shellMatrix(closedMesh(6), 1.0, 0.0);
  const std::vector<int> fixed = {0, 17, 18, 200, 361};
  for (const int node : fixed) matrix.fix(node);
  expectSolves(matrix, generator);
  Factor factor(makeFactorPlan(matrix.pattern()));
  ASSERT_TRUE(factor.compute(matrix));
  Eigen::VectorXd b = randomVector(3 * matrix.pattern().size, generator);
  for (const int node : fixed) b.segment<3>(3 * node).setZero();
  const Eigen::VectorXd x = solveFloat(factor, b);
  for (const int node : fixed) EXPECT_EQ(x.segment<3>(3 * node).norm(), 0) << node;
  EXPECT_GT(x.norm(), 0.1);
}

// the columns of an ill-conditioned matrix reach far beyond what a half holds unscaled
TEST(FactorTest, HalfPrecisionPreconditionsStiffMatrices) {
  std::mt19937 generator(16);
  const BlockMatrix matrix = shellMatrix(closedMesh(8), 1e-4, 1e-9);
  Factor factor(makeFactorPlan(matrix.pattern()), FactorStorage::Half);
  ASSERT_TRUE(factor.compute(matrix));
  const Eigen::VectorXd x = solveFloat(factor, randomVector(3 * matrix.pattern().size, generator));
  EXPECT_TRUE(x.allFinite());
  EXPECT_GT(x.norm(), 1);
}

TEST(FactorTest, HalfColumnsGiveBlocksOfTheInverse) {
  const BlockMatrix matrix = shellMatrix(closedMesh(7), 1.0, 0.1);
  const int nodes = matrix.pattern().size;
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> reference(eigenMatrix(matrix));
  const auto plan = makeFactorPlan(matrix.pattern());
  for (const auto& [storage, tolerance] : {std::pair(FactorStorage::Half, 4e-3), std::pair(FactorStorage::Float, 1e-5),
                                           std::pair(FactorStorage::Double, 1e-5)}) {
    Factor factor(plan, storage);
    ASSERT_TRUE(factor.compute(matrix));
    HalfColumns columns;
    for (int node = 0; node < nodes; node += 23) {
      Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(3 * nodes, 3);
      unit.middleRows(3 * node, 3).setIdentity();
      const Eigen::Matrix3d expected = Eigen::MatrixXd(reference.solve(unit)).middleRows(3 * node, 3);
      factor.halfColumns(node, columns);
      const Eigen::MatrixXd z =
          Eigen::Map<const Eigen::MatrixXf>(columns.value.data(), 3, columns.value.size() / 3).cast<double>();
      EXPECT_LT((z * z.transpose() - expected).norm(), tolerance * expected.norm()) << node;
    }
  }
}

TEST(FactorTest, HalfColumnsAreTheForwardSubstitutionOfUnitVectors) {
  const BlockMatrix matrix = shellMatrix(closedMesh(7), 1.0, 0.1);
  Factor factor(makeFactorPlan(matrix.pattern()), FactorStorage::Half);
  ASSERT_TRUE(factor.compute(matrix));
  HalfColumns columns;
  for (const int node : {0, 5, 77, 300}) {
    factor.halfColumns(node, columns);
    for (int a = 0; a < 3; ++a) {
      std::vector<float> nodes4(4 * matrix.pattern().size, 0.0F), vector(factor.rows());
      nodes4[4 * node + a] = 1;
      factor.load(nodes4.data(), vector.data());
      factor.forward(vector.data());
      std::size_t at = 0;
      for (std::size_t run = 0; run < columns.begin.size(); ++run)
        for (int i = 0; i < columns.count[run]; ++i, ++at) {
          EXPECT_NEAR(columns.value[3 * at + a], vector[columns.begin[run] + i], 1e-6F);
          vector[columns.begin[run] + i] = 0;
        }
      EXPECT_EQ(*std::max_element(vector.begin(), vector.end()), 0) << "a number outside the runs";
      EXPECT_EQ(*std::min_element(vector.begin(), vector.end()), 0) << "a number outside the runs";
    }
  }
}

TEST(FactorTest, GivesTheSameBitsTwice) {
  std::mt19937 generator(17);
  const BlockMatrix matrix = shellMatrix(closedMesh(9), 1.0, 0.1);
  const Eigen::VectorXd b = randomVector(3 * matrix.pattern().size, generator);
  Factor first(makeFactorPlan(matrix.pattern()));
  ASSERT_TRUE(first.compute(matrix));
  const Eigen::VectorXd x = solveFloat(first, b);
  EXPECT_EQ(solveFloat(first, b), x);
  Factor second(makeFactorPlan(matrix.pattern()));
  ASSERT_TRUE(second.compute(shellMatrix(closedMesh(9), 3.0, 0.2)));  // must leave no trace
  EXPECT_GT((solveFloat(second, b) - x).norm(), 0);
  ASSERT_TRUE(second.compute(matrix));
  EXPECT_EQ(solveFloat(second, b), x);
}

TEST(FactorTest, GivesTheSameBitsWithAnyNumberOfThreads) {
  std::mt19937 generator(19);
  const BlockMatrix matrix = shellMatrix(closedMesh(12), 1.0, 0.1);
  const Eigen::VectorXd b = randomVector(3 * matrix.pattern().size, generator);
  const auto plan = makeFactorPlan(matrix.pattern());
  ASSERT_GE(plan->branches.size(), 8u);
  ASSERT_GE(plan->tasks.size(), plan->branches.size() + 4) << "a trunk of a root alone tests nothing";
  ASSERT_GT(plan->record_size, 0) << "branches that share nothing test nothing";
  ASSERT_GE(plan->steps.back().columns, 64) << "a front of one piece tests nothing";
  for (const FactorStorage storage : {FactorStorage::Half, FactorStorage::Float, FactorStorage::Double}) {
    Factor factor(plan, storage);
    ASSERT_TRUE(factor.compute(matrix));
    const Eigen::VectorXf start = b.cast<float>();
    std::vector<float> once(start.begin(), start.end());
    factor.forward(once.data());
    const std::vector<float> half_way = once;
    factor.backward(once.data());
    for (const int threads : {1, 2, 3, 5}) {
      ThreadPool pool(threads);
      std::vector<float> vector(start.begin(), start.end());
      factor.forward(vector.data(), pool);
      EXPECT_EQ(vector, half_way);
      factor.backward(vector.data(), pool);
      EXPECT_EQ(vector, once);
      Factor shared(plan, storage);
      ASSERT_TRUE(shared.compute(matrix, pool));
      vector.assign(start.begin(), start.end());
      shared.forward(vector.data());
      shared.backward(vector.data());
      EXPECT_EQ(vector, once) << "made by " << threads << " threads";
    }
  }
}

// The pivot of the second node is 2e-6, of which single precision would lose three percent.
TEST(FactorTest, SmallPivotsAreComputedInDoublePrecision) {
  constexpr double kWeak = 1e-6;
  const std::vector<int> both = {0, 1};
  BlockMatrix matrix(std::make_shared<BlockPattern>(blockPattern(2, {{&both, 2}})));
  const Eigen::Matrix3d unit = Eigen::Matrix3d::Identity();
  for (const int node : both) matrix.add(node, node, (1 + kWeak) * unit);
  matrix.add(1, 0, -unit);
  Factor factor(makeFactorPlan(matrix.pattern()), FactorStorage::Half);
  ASSERT_TRUE(factor.compute(matrix));
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(6);
  EXPECT_LT((kWeak * solveFloat(factor, b) - b).norm(), 3e-3 * b.norm());
}

TEST(FactorTest, RefusesWhatIsNotPositiveDefinite) {
  std::mt19937 generator(18);
  const BlockMatrix good = shellMatrix(closedMesh(4), 1.0, 0.1);
  const int nodes = good.pattern().size;
  const Eigen::VectorXd b = randomVector(3 * nodes, generator);
  Factor factor(makeFactorPlan(good.pattern()));
  ASSERT_TRUE(factor.compute(good));
  const Eigen::VectorXd x = solveFloat(factor, b);

  BlockMatrix negative = good, indefinite = good, poisoned = good;
  negative.add(9, 9, -50.0 * Eigen::Matrix3d::Identity());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum{Eigen::MatrixXd(eigenMatrix(good)),
                                                                Eigen::EigenvaluesOnly};
  for (int i = 0; i < nodes; ++i) indefinite.add(i, i, -1.01 * spectrum.eigenvalues()[0] * Eigen::Matrix3d::Identity());
  poisoned.add(7, 7, std::numeric_limits<double>::quiet_NaN() * Eigen::Matrix3d::Identity());
  BlockMatrix poisoned_beside = good;
  poisoned_beside.add(good.pattern().size - 1, good.pattern().column.back(),
                      std::numeric_limits<double>::quiet_NaN() * Eigen::Matrix3d::Identity());
  EXPECT_FALSE(factor.compute(negative));
  EXPECT_FALSE(factor.compute(indefinite));
  EXPECT_FALSE(factor.compute(poisoned));
  EXPECT_FALSE(factor.compute(poisoned_beside));
  EXPECT_FALSE(factor.compute(BlockMatrix(std::make_shared<BlockPattern>(good.pattern()))));
  ASSERT_TRUE(factor.compute(good));
  EXPECT_EQ(solveFloat(factor, b), x);
}

TEST(FactorTest, RefusesAMatrixOfAnotherPattern) {
  Factor factor(makeFactorPlan(test::shellPattern(closedMesh(2))));
  EXPECT_THROW(factor.compute(shellMatrix(closedMesh(3), 1, 1)), Error);
  std::vector<double> x(3 * 42);
  EXPECT_THROW(factor.solve(x.data(), x.data()), Error);
}

}  // namespace
}  // namespace vibe::factor_test
