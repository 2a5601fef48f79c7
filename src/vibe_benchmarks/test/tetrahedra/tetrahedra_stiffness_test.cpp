#include <gtest/gtest.h>

#include "tetrahedra/tetrahedra_worlds.hpp"

namespace vibe::benchmarks::tetrahedra_stiffness_test {
namespace {

using namespace test;

TEST(TetrahedraStiffness, GradientIsThatOfTheEnergy) {
  forAllElements([](const ElasticElements& elements, const auto&) {
    Eigen::VectorXd u = randomDisplacement(elements.nodeCount(), 0.12 * kSide);
    const Eigen::VectorXd gradient = inDouble(elements, u).gradient;
    const double h = 1e-5 * kSide;
    for (Eigen::Index i = 0; i < u.size(); ++i) {
      const double at = u[i];
      u[i] = at + h;
      const double above = inDouble(elements, u).energy;
      u[i] = at - h;
      const double below = inDouble(elements, u).energy;
      u[i] = at;
      EXPECT_NEAR(gradient[i], (above - below) / (2 * h), 1e-6 * gradient.lpNorm<Eigen::Infinity>());
    }
  });
}

Eigen::MatrixXd differentiatedGradient(const ElasticElements& elements, Eigen::VectorXd u) {
  const double h = 1e-6 * kSide;
  Eigen::MatrixXd out(u.size(), u.size());
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    const double at = u[i];
    u[i] = at + h;
    out.col(i) = inDouble(elements, u).gradient;
    u[i] = at - h;
    out.col(i) -= inDouble(elements, u).gradient;
    u[i] = at;
  }
  return out / (2 * h);
}

// With a moderate change of volume and no large compression all points have a positive semidefinite tangent.
TEST(TetrahedraStiffness, StiffnessIsTheSecondDerivativeWhereThatIsPositive) {
  forAllElements([](const ElasticElements& elements, const std::vector<Eigen::Vector3d>& nodes) {
    Eigen::VectorXd u = randomDisplacement(elements.nodeCount(), 0.005 * kSide);
    const Eigen::Matrix3d f = someRotation() * Eigen::Vector3d(1.18, 1.0, 0.9).asDiagonal();
    for (std::size_t i = 0; i < nodes.size(); ++i)
      u.segment<3>(3 * static_cast<Eigen::Index>(i)) += f * nodes[i] - nodes[i];
    const Eigen::MatrixXd exact = differentiatedGradient(elements, u), ours = denseStiffness(elements, u);
    EXPECT_LT((exact - ours).norm(), 1e-6 * exact.norm());
  });
}

TEST(TetrahedraStiffness, StiffnessIsPositiveSemidefiniteInAnyState) {
  forAllElements(
      [](const ElasticElements& elements, const std::vector<Eigen::Vector3d>& nodes) {
        for (const double amount : {0.2, 1.0, 10.0}) {
          Eigen::VectorXd u = randomDisplacement(elements.nodeCount(), amount * kSide);
          if (amount == 1.0)  // all inside out
            for (std::size_t i = 0; i < nodes.size(); ++i) u[3 * static_cast<Eigen::Index>(i)] -= 2 * nodes[i].x();
          const Eigen::MatrixXd k = denseStiffness(elements, u);
          ASSERT_TRUE(k.allFinite());
          const auto values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(k).eigenvalues();
          EXPECT_GT(values.minCoeff(), -1e-12 * values.maxCoeff()) << amount;
        }
      },
      {1, 1, 1});
}

// The control of the test above: the exact second derivative is not positive at such a state.
TEST(TetrahedraStiffness, SecondDerivativeItselfIsIndefiniteWhenCompressed) {
  const TetElements<4> elements(linearMesh(Law::NeoHookean));
  const Eigen::VectorXd u = affine(elements.mesh(), Eigen::Vector3d(0.4, 1, 1).asDiagonal());
  const Eigen::MatrixXd exact = differentiatedGradient(elements, u);
  const Eigen::MatrixXd symmetric = (exact + exact.transpose()) / 2;
  EXPECT_LT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric).eigenvalues().minCoeff(), -0.1);
}

}  // namespace
}  // namespace vibe::benchmarks::tetrahedra_stiffness_test
