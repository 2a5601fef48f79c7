#include <gtest/gtest.h>

#include "tissue/shell_worlds.hpp"

namespace vibe::shell_stiffness_test {
namespace {

using namespace test;

Eigen::MatrixXd differentiatedGradient(const ShellElements& elements, Eigen::VectorXd u) {
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

// Flat and in tension the wall has no moment, and Gauss-Newton leaves nothing out.
TEST(ShellStiffness, StiffnessIsTheSecondDerivativeInAFlatStretchedSheet) {
  for (const Law law : kLaws) {
    ShellMesh mesh = shaken(sheet(4, 3, law), 0.12 * kSide, true);
    mesh.fixed.assign(mesh.nodes.size(), 0);
    for (std::size_t i = 0; i < 4; ++i) mesh.fixed[i] = 1;
    mesh.hinged = {{8, 9}};
    const ShellElements elements(mesh);
    // free to turn: a clamp holds the tangent plane at rest
    const Eigen::VectorXd u = affine(mesh, Eigen::Vector3d(1.25, 1.15, 1).asDiagonal());
    const Eigen::MatrixXd exact = differentiatedGradient(elements, u), ours = denseStiffness(elements, u);
    EXPECT_LT((exact - ours).norm(), 1e-6 * exact.norm()) << static_cast<int>(law);
  }
}

TEST(ShellStiffness, StiffnessIsTheSecondDerivativeAtRest) {
  forAllShells([](const ShellElements& elements) {
    const Eigen::VectorXd u = Eigen::VectorXd::Zero(3 * elements.nodeCount());
    const Eigen::MatrixXd exact = differentiatedGradient(elements, u), ours = denseStiffness(elements, u);
    EXPECT_LT((exact - ours).norm(), 1e-6 * exact.norm());
  });
}

TEST(ShellStiffness, StiffnessIsPositiveSemidefiniteInAnyState) {
  forAllShells([](const ShellElements& elements) {
    for (const double amount : {0.2, 1.0, 10.0}) {
      const Eigen::MatrixXd k = denseStiffness(elements, randomDisplacement(elements.nodeCount(), amount * kSide));
      ASSERT_TRUE(k.allFinite());
      const auto values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(k).eigenvalues();
      EXPECT_GT(values.minCoeff(), -1e-12 * values.maxCoeff()) << amount;
    }
    ASSERT_TRUE(denseStiffness(elements, affine(elements.mesh(), Eigen::Matrix3d::Zero())).allFinite());
  });
}

// The control of the test above: the exact second derivative is not positive at such a state.
TEST(ShellStiffness, SecondDerivativeItselfIsIndefiniteWhenCompressed) {
  const ShellElements elements(sheet(3, 3));
  const Eigen::VectorXd u = affine(elements.mesh(), Eigen::Vector3d(0.6, 1, 1).asDiagonal());
  const Eigen::MatrixXd exact = differentiatedGradient(elements, u);
  const Eigen::MatrixXd symmetric = (exact + exact.transpose()) / 2;
  EXPECT_LT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric).eigenvalues().minCoeff(), -0.1);
}

// A tetrahedron's surface: each apex is beyond two sides of some triangle, so that blocks meet on the diagonal.
TEST(ShellStiffness, PatchMayMeetANodeTwice) {
  ShellMesh mesh;
  mesh.nodes = {{0.01, 0.01, 0.01}, {0.01, -0.01, -0.01}, {-0.01, 0.01, -0.01}, {-0.01, -0.01, 0.01}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  mesh.nodes[3] *= 0.9;
  finish(mesh, Law::NeoHookean);
  const ShellElements elements(mesh);
  const Eigen::VectorXd u = Eigen::VectorXd::Zero(12);
  const Eigen::MatrixXd exact = differentiatedGradient(elements, u), ours = denseStiffness(elements, u);
  EXPECT_LT((exact - ours).norm(), 1e-6 * exact.norm());
}

}  // namespace
}  // namespace vibe::shell_stiffness_test
