// The sparse factor against CHOLMOD (Chen, Davis, Hager, Rajamanickam 2008), an independent program, on the matrices
// that a simulation has.
#include <gtest/gtest.h>

#include <Eigen/CholmodSupport>
#include <random>

#include "sparse/eigen_matrix.hpp"
#include "sparse/stiffness_worlds.hpp"

namespace vibe::cholmod_test {
namespace {

using test::eigenMatrix;
using Cholmod = Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower>;

Eigen::VectorXd loadOn(const BlockMatrix& matrix) {
  std::mt19937 generator(21);
  std::normal_distribution<double> normal;
  Eigen::VectorXd b(3 * matrix.pattern().size);
  for (double& value : b) value = static_cast<double>(static_cast<float>(normal(generator)));
  return b;
}

Eigen::VectorXd solveSingle(const Factor& factor, const Eigen::VectorXd& b) {
  std::vector<float> nodes4(4 * static_cast<std::size_t>(b.size()) / 3, 0.0F);
  std::vector<float> vector(static_cast<std::size_t>(factor.rows()) + 16, 0.0F);
  for (int i = 0; i < b.size(); ++i) nodes4[4 * (i / 3) + i % 3] = static_cast<float>(b[i]);
  factor.load(nodes4.data(), vector.data());
  factor.forward(vector.data());
  factor.backward(vector.data());
  factor.store(vector.data(), nodes4.data());
  Eigen::VectorXd x(b.size());
  for (int i = 0; i < x.size(); ++i) x[i] = nodes4[4 * (i / 3) + i % 3];
  return x;
}

double difference(const Eigen::VectorXd& x, const Eigen::VectorXd& expected) {
  return (x - expected).norm() / expected.norm();
}

void expectTheSolutionsOfCholmod(const BlockMatrix& matrix) {
  ASSERT_GT(matrix.diagonal()[0].norm(), 0) << "the matrix is not positive definite";
  const Eigen::VectorXd b = loadOn(matrix);
  const Cholmod cholmod(eigenMatrix(matrix));
  ASSERT_EQ(cholmod.info(), Eigen::Success);
  const Eigen::VectorXd expected = cholmod.solve(b);

  const auto plan = makeFactorPlan(matrix.pattern());
  Factor wide(plan, FactorStorage::Double), single(plan, FactorStorage::Float), half(plan, FactorStorage::Half);
  for (Factor* factor : {&wide, &single, &half}) ASSERT_TRUE(factor->compute(matrix));
  Eigen::VectorXd x(b.size());
  wide.solve(b.data(), x.data());
  EXPECT_LT(difference(x, expected), 1e-12);
  EXPECT_LT(difference(solveSingle(single, b), expected), 1e-5);
  EXPECT_LT(difference(solveSingle(half, b), expected), 3e-3);

  // negative control: a spring at one node is seen
  BlockMatrix other = matrix;
  other.add(0, 0, 1e-6 * matrix.diagonal()[0].trace() * Eigen::Matrix3d::Identity());
  ASSERT_TRUE(wide.compute(other));
  wide.solve(b.data(), x.data());
  EXPECT_GT(difference(x, expected), 1e-11);
}

TEST(CholmodComparison, TheWallOfTheStomach) {
  expectTheSolutionsOfCholmod(test::stiffnessOf(test::stomachBody(VIBE_CORE_DIR "/scenes/stomach.yaml")));
}

TEST(CholmodComparison, ABlockOfTetrahedra) {
  expectTheSolutionsOfCholmod(test::stiffnessOf(test::cantilever({8, 6, 5})));
}

}  // namespace
}  // namespace vibe::cholmod_test
